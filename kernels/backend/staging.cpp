// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/backend/staging.hpp"

#include "core/base/memory/device.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>

namespace rg::gpu {
namespace {

DeviceError hangError() {
  return {DeviceError::Kind::Lost,
          "no answer for " + std::to_string(kHangNs / 1'000'000'000) + " seconds"};
}

}  // namespace

/// What hangs may still write to what it was given: that stays.
Staging::~Staging() {
  if (hangs_) return;
  for (const Block& block : blocks_) {
    if (block.copied != nullptr) runtime::endEvent(block.copied);
    if (block.memory != nullptr) runtime::releaseOnHost(block.memory);
  }
}

void Staging::upload(void* to, const void* from, size_t bytes) {
  submit(stream_);
  Block& block = take(bytes);
  std::memcpy(block.memory, from, bytes);
  runtime::upload(to, block.memory, bytes, stream_);
  runtime::record(block.copied, stream_);
  give(block, Block::Use::Copied);
}

void Staging::download(std::initializer_list<Download> copies) {
  submit(stream_);
  std::array<Block*, kMostTogether> blocks{};
  size_t begun = 0;
  for (const Download& copy : copies) {
    Block* block = copy.bytes > 0 ? &take(copy.bytes) : nullptr;
    blocks.at(begun++) = block;
    if (block == nullptr) continue;
    runtime::download(block->memory, copy.from, copy.bytes, stream_);
    runtime::record(block->copied, stream_);
  }
  size_t done = 0;
  for (const Download& copy : copies) {
    Block* block = blocks.at(done++);
    if (block == nullptr) continue;
    waitFor(*block);
    std::memcpy(copy.to, block->memory, copy.bytes);
    give(*block, Block::Use::None);
  }
}

void Staging::expectAlive() const {
  if (hangs_) throw hangError();
}

/// A block that nobody gives back, for its copy failed, is never used again: it may be in use.
Staging::Block& Staging::take(size_t bytes) {
  constexpr size_t kLeast = size_t{1} << 16;
  const size_t rounded = std::bit_ceil(std::max(bytes, kLeast));
  const int64_t begin = runtime::clockNs();
  for (;;) {
    const int64_t waited = runtime::clockNs() - begin;
    {
      const std::lock_guard lock(mutex_);
      int onTheWay = 0;
      if (Block* block = findFree(rounded, onTheWay)) return *block;
      if (onTheWay < kMostOfSize) return make(rounded);
    }
    goOn(waited);
  }
}

Staging::Block* Staging::findFree(size_t bytes, int& onTheWay) {
  for (Block& block : blocks_) {
    if (block.bytes != bytes || block.use == Block::Use::Taken) continue;
    if (block.use == Block::Use::Copied && !runtime::isDone(block.copied)) {
      ++onTheWay;
      continue;
    }
    block.use = Block::Use::Taken;
    return &block;
  }
  return nullptr;
}

Staging::Block& Staging::make(size_t bytes) {
  Block& block = blocks_.emplace_back();
  block.use = Block::Use::Taken;
  block.copied = runtime::makeEvent();
  block.memory = runtime::allocateOnHost(bytes);
  block.bytes = bytes;
  return block;
}

void Staging::waitFor(Block& block) {
  const int64_t begin = runtime::clockNs();
  for (;;) {
    // Before the question: who was stopped for long asks once more.
    const int64_t waited = runtime::clockNs() - begin;
    if (runtime::isDone(block.copied)) return;
    goOn(waited);
  }
}

void Staging::goOn(int64_t waitedNs) {
  if (waitedNs > kHangNs) hangs_ = true;
  expectAlive();
  runtime::rest(waitedNs);
}

void Staging::give(Block& block, Block::Use use) {
  const std::lock_guard lock(mutex_);
  block.use = use;
}

}  // namespace rg::gpu
