// SPDX-License-Identifier: LGPL-2.1-or-later
// Where an operation runs: on the device where there is a kernel, else on the CPU, with what it
// needs brought there.
//
// A kernel that changes something in place is the last of its operation's calls that can fail: so
// the CPU finds what the operation found.
#pragma once

#include "kernels/backend/access.hpp"
#include "kernels/backend/gpu_device.hpp"
#include "kernels/components.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace rg::gpu {

/// A list on the device, and where it comes to.
template <class T>
struct FetchedList {
  const T* from;
  uint32_t count;
  std::vector<T>& to;
};
/// One whose length the device knows only: seldom more than `expected`, for which there is memory.
template <class T>
struct CountedList {
  const uint32_t* count;
  const T* from;
  uint32_t expected;
  std::vector<T>& to;
};

class Dispatcher {
 public:
  explicit Dispatcher(GpuDevice& device) : device_(device), access_(device) {}

  /// onCpu where the device has failed, or fails at this. Accesses are what onCpu does with images.
  /// Throws DeviceError when the device is lost, with what was on it.
  template <class OnDevice, class OnCpu, class... Accesses>
  void run(const OnDevice& onDevice, const OnCpu& onCpu, const Accesses&... accesses) {
    const auto attempt = [&] {
      device_.lane()->enter();
      device_.scratch().begin();
      onDevice();
    };
    if (!device_.isUp() || !tryTo(attempt)) onHost(onCpu, accesses...);
  }
  /// run() for what leaves nothing on the device that the CPU would need: no error leaves.
  template <class OnDevice, class OnCpu>
  void runOrCatchUp(const OnDevice& onDevice, const OnCpu& onCpu) {
    try {
      run(onDevice, onCpu);
    } catch (const DeviceError&) {
      onCpu();
    }
  }
  /// For what has no kernel. A copy that fails is tried once more: what it was to bring is nowhere
  /// else.
  template <class OnCpu, class... Accesses>
  std::invoke_result_t<const OnCpu&> onHost(const OnCpu& onCpu, const Accesses&... accesses) {
    if (!tryTo([&] { (accesses.bringToHost(), ...); }) &&
        !tryTo([&] { (accesses.bringToHost(), ...); }))
      throw DeviceError(DeviceError::Kind::Lost, device_.error()->what());
    return onCpu();
  }

  /// onDevice(answer) writes it to the device's memory, from where it is fetched; or what onCpu
  /// answers.
  template <class Answer, class OnDevice, class OnCpu, class... Accesses>
  Answer ask(const OnDevice& onDevice, const OnCpu& onCpu, const Accesses&... accesses) {
    Answer answer{};
    run(
        [&] {
          auto* there = scratch().take<Answer>(1);
          onDevice(there);
          fetch(&answer, there, sizeof answer);
        },
        [&] { answer = onCpu(); }, accesses...);
    return answer;
  }

  [[nodiscard]] Device& device() const { return device_; }
  [[nodiscard]] const Access& on() const { return access_; }
  [[nodiscard]] Scratch& scratch() const { return device_.scratch(); }
  [[nodiscard]] Stream stream() const { return device_.lane()->stream(); }
  /// Lets the device begin with what it was given, for whoever does something else meanwhile.
  void letBegin() const { submit(stream()); }
  [[nodiscard]] ComponentsView components(Size size) const;
  /// In scratch, contents undefined.
  [[nodiscard]] BitTarget scratchMask(Size size) const;
  template <class T>
  [[nodiscard]] ImageView<T> scratchPlane(Size size) const {
    const int64_t stride = int64_t{wordsOf(size.width)} * kWordColumns;
    return {scratch().take<T>(stride * size.height + kWordColumns), size,
            static_cast<ptrdiff_t>(stride * static_cast<int64_t>(sizeof(T)))};
  }
  [[nodiscard]] PlaneTargets scratchPlanes(Size size, int channels) const;
  /// In scratch.
  [[nodiscard]] BitTarget copyOf(const BitView& mask) const;
  void copy(const BitView& from, const BitTarget& to) const;
  /// Zeros.
  void clear(ImageView<uint8_t> plane) const;
  void send(void* to, const void* from, size_t bytes) const;
  /// In scratch.
  template <class T>
  [[nodiscard]] const T* sent(std::span<const T> list) const {
    auto* there = scratch().take<T>(static_cast<int64_t>(list.size()));
    send(there, list.data(), list.size_bytes());
    return there;
  }
  template <class T>
  [[nodiscard]] const T* sent(const std::vector<T>& list) const {
    return sent(std::span<const T>(list));
  }
  /// Waits for it.
  template <class T>
  [[nodiscard]] T fetched(const T* from) const {
    T value{};
    fetch(&value, from, sizeof value);
    return value;
  }
  /// Waits for all of them together.
  template <class... T>
  void fetchLists(const FetchedList<T>&... lists) const {
    (lists.to.resize(lists.count), ...);
    staging().download(
        {Staging::Download{lists.to.data(), lists.from, lists.count * sizeof(T)}...});
  }
  /// Waits for all of them together, and again where the first is longer than expected.
  template <class T, class... Others>
  void fetchCounted(const CountedList<T>& list, const FetchedList<Others>&... others) const {
    uint32_t count = 0;
    list.to.resize(list.expected);
    (others.to.resize(others.count), ...);
    staging().download(
        {{&count, list.count, sizeof count},
         {list.to.data(), list.from, list.expected * sizeof(T)},
         Staging::Download{others.to.data(), others.from, others.count * sizeof(Others)}...});
    list.to.resize(count);
    if (count > list.expected)
      fetch(list.to.data() + list.expected, list.from + list.expected,
            (count - list.expected) * sizeof(T));
  }

 private:
  [[nodiscard]] Staging& staging() const { return device_.lane()->staging(); }
  void fetch(void* to, const void* from, size_t bytes) const;

  template <class Call>
  bool tryTo(const Call& call) {
    try {
      call();
      return true;
    } catch (const DeviceError& error) {
      device_.fail(error);
      if (error.isLost()) throw;
      return false;
    }
  }

  GpuDevice& device_;
  Access access_;
};

}  // namespace rg::gpu
