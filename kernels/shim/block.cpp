// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/shim/block.hpp"

#include "core/base/pixel.hpp"
#include "kernels/shim/fiber.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace rg::gpu::shim {
namespace {

constexpr uint32_t kWarpLanes = 32;
constexpr size_t kMostFindings = 5;

enum class State : uint8_t { Fresh, Ready, AtBlock, AtWarp, Done };

struct Warp {
  /// In turn: what was given last may be read until all have given something again.
  std::array<std::array<uint64_t, kWarpLanes>, 2> values;
  uint32_t arrived = 0;
  uint32_t moment = 0;
};

struct Thread {
  Extent index;
  State state = State::Done;
  uint32_t fiber = 0;                       ///< That it runs on, once it is no more fresh.
  std::array<uint64_t, kWarpLanes> seen{};  ///< What its warp gave.
};

class Machine {
 public:
  void begin(const Schedule& schedule) {
    schedule_ = schedule;
    findings_.clear();
    launches_.clear();
  }
  void run(const Launch& launch, const Task<>& body);

  void waitForBlock();
  const std::array<uint64_t, 32>& waitForWarp(uint64_t value);
  [[nodiscard]] Moment now() const { return {moment_, warps_[current_ / 32].moment, current_}; }
  [[nodiscard]] uint32_t blockSerial() const { return serial_; }
  void report(const std::string& what) {
    if (findings_.size() < kMostFindings)
      findings_.push_back((launch_ ? std::string(launch_->name) + ": " : std::string()) + what);
  }
  [[nodiscard]] const Schedule& schedule() const { return schedule_; }
  [[nodiscard]] const std::vector<std::string>& findings() const { return findings_; }
  [[nodiscard]] const std::vector<Launch>& launches() const { return launches_; }

 private:
  static void enter(void* self) { static_cast<Machine*>(self)->live(); }
  void live();
  void suspend(State state);
  void prepare(uint32_t count, const Extent& block);
  void runBlock(uint32_t count);
  bool runReady();
  bool findReady();
  void startOn(uint32_t fiber);
  void freeFibers();
  std::vector<uint32_t> orderOf(uint32_t count);

  Schedule schedule_;
  std::vector<std::string> findings_;
  std::vector<Launch> launches_;
  const Launch* launch_ = nullptr;
  const Task<>* body_ = nullptr;
  std::vector<Thread> threads_;
  std::vector<Fiber> fibers_;
  std::vector<uint32_t> idle_;  ///< Fibers that no thread is on.
  std::vector<uint32_t> order_;
  size_t next_ = 0;  ///< In it: who comes next.
  std::vector<Warp> warps_;
  uint32_t current_ = 0, count_ = 0, waiting_ = 0, done_ = 0;
  uint32_t moment_ = 0, serial_ = 0, drawn_ = 0;
};

/// What a fiber does for ever: one thread to its end, and on the same stack the next ones that have
/// not begun, so that threads that wait for nobody need no switch.
void Machine::live() {
  for (;;) {
    (*body_)();
    Thread& thread = threads_[current_];
    const uint32_t fiber = thread.fiber;
    thread.state = State::Done;
    ++done_;
    if (findReady() && threads_[order_[next_]].state == State::Fresh) {
      startOn(fiber);
    } else {
      idle_.push_back(fiber);
      fibers_[fiber].suspend();
    }
  }
}

void Machine::suspend(State state) {
  Thread& thread = threads_[current_];
  thread.state = state;
  fibers_[thread.fiber].suspend();
}

void Machine::waitForBlock() {
  if (++waiting_ < count_) return suspend(State::AtBlock);
  waiting_ = 0;
  ++moment_;
  for (uint32_t i = 0; i < count_; ++i)
    if (threads_[i].state == State::AtBlock) threads_[i].state = State::Ready;
}

const std::array<uint64_t, 32>& Machine::waitForWarp(uint64_t value) {
  Warp& warp = warps_[current_ / kWarpLanes];
  const uint32_t lane = current_ % kWarpLanes, first = current_ - lane;
  std::array<uint64_t, kWarpLanes>& values = warp.values[warp.moment % 2];
  values[lane] = value;
  warp.arrived |= uint32_t{1} << lane;
  if (warp.arrived != ~uint32_t{0}) {
    suspend(State::AtWarp);
    return values;
  }
  warp.arrived = 0;
  ++warp.moment;
  for (uint32_t i = first; i < first + kWarpLanes; ++i)
    if (threads_[i].state == State::AtWarp) threads_[i].state = State::Ready;
  return values;
}

std::vector<uint32_t> Machine::orderOf(uint32_t count) {
  std::vector<uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  if (schedule_.order == Order::Reversed) std::reverse(order.begin(), order.end());
  if (schedule_.order == Order::Random)
    for (uint32_t i = count; i > 1; --i)
      std::swap(order[i - 1], order[mixHash(schedule_.seed, ++drawn_, i) % i]);
  return order;
}

/// Goes on to a thread that can run.
bool Machine::findReady() {
  while (next_ < order_.size() && threads_[order_[next_]].state > State::Ready) ++next_;
  return next_ < order_.size();
}

/// Of the next thread, which is fresh.
void Machine::startOn(uint32_t fiber) {
  current_ = order_[next_++];
  Thread& thread = threads_[current_];
  threadIdx = thread.index;
  thread.state = State::Ready;
  thread.fiber = fiber;
}

bool Machine::runReady() {
  bool hasMoved = false;
  for (next_ = 0; findReady(); hasMoved = true) {
    if (threads_[order_[next_]].state == State::Fresh) {
      const uint32_t fiber = idle_.back();
      idle_.pop_back();
      startOn(fiber);
    } else {
      current_ = order_[next_++];
      threadIdx = threads_[current_].index;
    }
    fibers_[threads_[current_].fiber].resume();
  }
  return hasMoved;
}

void Machine::runBlock(uint32_t count) {
  ++moment_;
  ++serial_;
  waiting_ = done_ = 0;
  for (uint32_t i = 0; i < count; ++i) threads_[i].state = State::Fresh;
  order_ = orderOf(count);
  while (done_ < count) {
    if (runReady()) continue;
    report("a barrier that not all threads come to");
    freeFibers();
    for (Warp& warp : warps_) warp.arrived = 0;
    return;
  }
}

void Machine::freeFibers() {
  idle_.clear();
  for (uint32_t i = 0; i < fibers_.size(); ++i) {
    fibers_[i].restart();
    idle_.push_back(i);
  }
}

void Machine::prepare(uint32_t count, const Extent& block) {
  if (count % kWarpLanes != 0 || count > 1024) report("a block of " + std::to_string(count));
  count_ = count;
  if (threads_.size() < count) threads_.resize(count);
  while (fibers_.size() < count) {
    idle_.push_back(static_cast<uint32_t>(fibers_.size()));
    fibers_.emplace_back(&Machine::enter, this);
  }
  warps_.resize((threads_.size() + kWarpLanes - 1) / kWarpLanes);
  for (uint32_t i = 0; i < count; ++i)
    threads_[i].index = {i % block.x, i / block.x % block.y, i / (block.x * block.y)};
}

void Machine::run(const Launch& launch, const Task<>& body) {
  launches_.push_back(launch);
  if (schedule_.mode == Mode::Record) return;
  launch_ = &launch;
  body_ = &body;
  const Extent &grid = launch.grid, &block = launch.block;
  prepare(block.x * block.y * block.z, block);
  blockDim = block;
  gridDim = grid;
  for (const uint32_t i : orderOf(grid.x * grid.y * grid.z)) {
    blockIdx = {i % grid.x, i / grid.x % grid.y, i / (grid.x * grid.y)};
    runBlock(count_);
  }
  launch_ = nullptr;
}

Machine& machine() {
  static Machine only;
  return only;
}

}  // namespace

void begin(const Schedule& schedule) {
  machine().begin(schedule);
}
const std::vector<std::string>& findings() {
  return machine().findings();
}
const std::vector<Launch>& launches() {
  return machine().launches();
}
void run(const Launch& launch, Task<> thread) {
  machine().run(launch, thread);
}
void clear(void* memory, size_t bytes) {
  if (machine().schedule().mode == Mode::Run) std::memset(memory, 0, bytes);
}
void report(const std::string& what) {
  machine().report(what);
}
Moment now() {
  return machine().now();
}
uint32_t blockSerial() {
  return machine().blockSerial();
}
void waitForBlock() {
  machine().waitForBlock();
}
const std::array<uint64_t, 32>& waitForWarp(uint64_t value) {
  return machine().waitForWarp(value);
}

}  // namespace rg::gpu::shim
