// SPDX-License-Identifier: LGPL-2.1-or-later
// What a stream is to be given, written down: kernels with copies of their arguments, clears and
// copies, one after the other.
#pragma once

#include "kernels/launch.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

namespace rg::gpu {

struct Command {
  enum class Kind : uint8_t { Kernel, Clear, Copy };
  static constexpr size_t kMostArguments = 16;
  /// How the host runs a kernel in a device's place (kernels/shim); CUDA needs no such function.
  using HostCall = void (*)(const Launch& launch, const void* kernel, const std::byte* arguments);

  Kind kind = Kind::Kernel;
  /// Of a kernel.
  Launch launch{};
  const void* kernel = nullptr;
  HostCall hostCall = nullptr;
  const size_t* places = nullptr;  ///< In bytes from its first argument.
  size_t argumentCount = 0;
  size_t firstWord = 0;  ///< Of its arguments, in the list.
  /// Of a clear, which has no source, or a copy.
  void* to = nullptr;
  const void* from = nullptr;
  size_t bytes = 0;
};

/// Where a kernel's arguments lie, each on a word of its own, and how many words they take.
template <class... Arguments>
struct ArgumentPlaces {
  static_assert(((std::is_trivially_copyable_v<Arguments> && alignof(Arguments) <= 8) && ...));
  static constexpr size_t kCount = sizeof...(Arguments);
  static_assert(kCount <= Command::kMostArguments);
  static constexpr size_t wordsOf(size_t bytes) { return (bytes + 7) / 8; }
  static constexpr size_t kWords = (wordsOf(sizeof(Arguments)) + ... + 0);
  static constexpr std::array<size_t, kCount + 1> kBytes = [] {
    std::array<size_t, kCount + 1> places{};
    size_t next = 0, i = 0;
    ((places[i++] = next, next += 8 * wordsOf(sizeof(Arguments))), ...);
    places[i] = next;
    return places;
  }();
};

class CommandList {
 public:
  [[nodiscard]] size_t size() const { return commands_.size(); }
  [[nodiscard]] const Command& operator[](size_t i) const { return commands_[i]; }
  [[nodiscard]] const std::byte* argumentsOf(const Command& command) const {
    return reinterpret_cast<const std::byte*>(words_.data() + command.firstWord);
  }
  /// For CUDA's calls, which take places that they only read as places to change.
  using Places = std::array<void*, Command::kMostArguments>;
  [[nodiscard]] Places placesOf(const Command& command) const;

  void clear() {
    commands_.clear();
    words_.clear();
  }
  template <class... Arguments>
  void addKernel(const Launch& launch, const void* kernel, Command::HostCall hostCall,
                 const Arguments&... arguments) {
    using Taken = ArgumentPlaces<Arguments...>;
    const size_t first = words_.size();
    words_.resize(first + Taken::kWords);
    size_t i = 0;
    auto* const bytes = reinterpret_cast<std::byte*>(words_.data() + first);
    (std::memcpy(bytes + Taken::kBytes[i++], &arguments, sizeof arguments), ...);
    commands_.push_back({Command::Kind::Kernel, launch, kernel, hostCall, Taken::kBytes.data(),
                         Taken::kCount, first});
  }
  void addClear(void* to, size_t bytes) {
    commands_.push_back({.kind = Command::Kind::Clear, .to = to, .bytes = bytes});
  }
  void addCopy(void* to, const void* from, size_t bytes) {
    commands_.push_back({.kind = Command::Kind::Copy, .to = to, .from = from, .bytes = bytes});
  }

  /// Alike in all but the kernels' grids, blocks and arguments, and where is cleared and copied.
  [[nodiscard]] bool hasShapeOf(const CommandList& other) const;
  [[nodiscard]] uint64_t hashOfShape() const;
  /// Of lists of one shape.
  [[nodiscard]] bool isSame(const CommandList& other, size_t i) const;
  void take(const CommandList& other, size_t i);

 private:
  [[nodiscard]] size_t wordsOf(const Command& command) const {
    return command.places == nullptr ? 0 : command.places[command.argumentCount] / 8;
  }

  std::vector<Command> commands_;
  std::vector<uint64_t> words_;  ///< All arguments.
};

}  // namespace rg::gpu
