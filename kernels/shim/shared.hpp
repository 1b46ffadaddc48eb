// SPDX-License-Identifier: LGPL-2.1-or-later
// A block's shared memory that knows who wrote it when.
#pragma once

#include "kernels/shim/block.hpp"

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>

namespace rg::gpu::shim {

[[nodiscard]] inline bool isOrdered(const Moment& before, const Moment& after) {
  return before.block != after.block || before.thread == after.thread ||
         (before.thread / 32 == after.thread / 32 && before.warp != after.warp);
}

/// Who touched an element last, since its block began.
struct Trace {
  Moment writer, reader, otherReader;
  bool isWritten = false, isAtomic = false;

  void read(const Moment& at, const char* name, size_t index) {
    if (!isWritten) complain("a read of what nobody wrote", name, index, at);
    if (isWritten && !isOrdered(writer, at))
      complain("a read without barrier after a write", name, index, at);
    if (reader.block != at.block || reader.thread == at.thread) {
      if (reader.block != at.block) otherReader = {};
      reader = at;
    } else if (otherReader.block != at.block) {
      otherReader = at;
    }
  }
  void write(const Moment& at, bool byAtomic, const char* name, size_t index) {
    if (isWritten && !isOrdered(writer, at) && !(isAtomic && byAtomic))
      complain("a write without barrier after a write", name, index, at);
    for (const Moment& before : {reader, otherReader})
      if (before.block != 0 && !isOrdered(before, at))
        complain("a write without barrier after a read", name, index, at);
    writer = at;
    isWritten = true;
    isAtomic = byAtomic;
  }

 private:
  static void complain(const char* what, const char* name, size_t index, const Moment& at) {
    report(std::string(what) + ": " + name + "[" + std::to_string(index) + "], thread " +
           std::to_string(at.thread));
  }
};

/// &array[i]: a place for atomics only.
template <class T>
struct AtomicPlace {
  T* value;
  Trace* trace;
  const char* name;
  size_t index;
};

template <class T>
class Element {
 public:
  Element(T& value, Trace& trace, const char* name, size_t index)
      : value_(value), trace_(trace), name_(name), index_(index) {}
  operator T() const {  // NOLINT(google-explicit-constructor)
    trace_.read(now(), name_, index_);
    return value_;
  }
  // NOLINTNEXTLINE(misc-unconventional-assign-operator): an element stands for a T.
  const Element& operator=(T value) const {
    trace_.write(now(), false, name_, index_);
    value_ = value;
    return *this;
  }
  const Element& operator=(const Element& other) const { return *this = static_cast<T>(other); }
  AtomicPlace<T> operator&() const {  // NOLINT(google-runtime-operator)
    return {&value_, &trace_, name_, index_};
  }

 private:
  T& value_;
  Trace& trace_;
  const char* name_;
  size_t index_;
};

/// One for each declaration; it starts anew with each block.
template <class T, size_t count>
class SharedArray {
 public:
  SharedArray& enter(const char* name) {
    name_ = name;
    if (serial_ != blockSerial()) traces_.fill({});
    serial_ = blockSerial();
    return *this;
  }
  Element<T> operator[](std::integral auto index) {
    const auto i = static_cast<size_t>(index);
    if (i < count) return {values_[i], traces_[i], name_, i};
    report(std::string("an index beyond ") + name_ + ": " + std::to_string(i));
    return {values_[0], traces_[0], name_, 0};
  }

 private:
  std::array<T, count> values_;
  std::array<Trace, count> traces_;
  const char* name_ = "";
  uint32_t serial_ = 0;
};

}  // namespace rg::gpu::shim

#define RG_SHARED(type, name, count)                        \
  static rg::gpu::shim::SharedArray<type, (count)> name##_; \
  auto& name = name##_.enter(#name)
