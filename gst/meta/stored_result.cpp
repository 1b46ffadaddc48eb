// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/meta/stored_result.hpp"

#include "gst/meta/result_fields.hpp"

#include <algorithm>
#include <concepts>
#include <utility>

namespace rg {
namespace {

/// Larger frames are refused by the elements too (gst/support/filter_base.cpp).
constexpr int64_t kMostPixels = int64_t{8192} * 4320;
constexpr int kLongestSide = 16384;

/// What lies farther from the frame would overflow where it is computed with.
constexpr bool isNear(int px) {
  return px > -(1 << 26) && px < 1 << 26;
}

template <class T>
concept Number = std::integral<T> && !std::same_as<T, bool>;
template <class T>
concept Enum = std::is_enum_v<T>;

class Writer {
 public:
  template <class... Values>
  void operator()(const Values&... values) {
    (write(values), ...);
  }
  [[nodiscard]] std::vector<uint8_t> take() { return std::move(bytes_); }

 private:
  template <Number T>
  void write(T value) {
    auto bits = static_cast<std::make_unsigned_t<T>>(value);
    for (size_t i = 0; i < sizeof(T); ++i, bits = static_cast<decltype(bits)>(uint64_t{bits} >> 8))
      bytes_.push_back(static_cast<uint8_t>(bits & 0xFF));
  }
  void write(bool value) { write(static_cast<uint8_t>(value)); }
  template <Enum T>
  void write(T value) {
    write(static_cast<uint8_t>(value));
  }
  template <class Kind, class T>
  void write(const Which<Kind, T>& which) {
    write(which.number());
  }
  template <class T>
  void write(const std::vector<T>& list) {
    write(static_cast<uint32_t>(list.size()));
    for (const T& value : list) write(value);
  }
  template <class T>
  void write(const ResultPlane<T>& plane) {
    write(plane.pixelSize());
    std::vector<T> scratch;
    for (int y = 0; y < plane.pixelSize().height; ++y)
      writeRow<T>({plane.unpackedRow(y, scratch), static_cast<size_t>(plane.pixelSize().width)});
  }
  /// Each run as its value and its length.
  template <class T>
  void writeRow(std::span<const T> row) {
    for (size_t from = 0, to = 0; from < row.size(); from = to) {
      while (to < row.size() && row[to] == row[from]) ++to;
      write(row[from]);
      write(static_cast<uint16_t>(to - from));
    }
  }
  template <class T>
  requires std::is_class_v<T>
  void write(const T& value) { pass(*this, value); }

  std::vector<uint8_t> bytes_;
};

/// Reads nothing more once something is wrong.
class Reader {
 public:
  explicit Reader(std::span<const uint8_t> bytes) : left_(bytes) {}

  template <class... Values>
  void operator()(Values&... values) {
    (read(values), ...);
  }
  [[nodiscard]] bool isDone() const { return isGood_ && left_.empty(); }

 private:
  template <Number T>
  void read(T& value) {
    if (!require(left_.size() >= sizeof(T))) return;
    uint64_t bits = 0;
    for (size_t i = 0; i < sizeof(T); ++i) bits |= uint64_t{left_[i]} << (8 * i);
    value = static_cast<T>(bits);
    left_ = left_.subspan(sizeof(T));
  }
  void read(bool& value) {
    uint8_t byte = 0;
    read(byte);
    value = byte != 0;
  }
  template <Enum T>
  void read(T& value) {
    uint8_t byte = 0;
    read(byte);
    if (require(byte <= lastOf(value))) value = static_cast<T>(byte);
  }
  template <class Kind, class T>
  void read(Which<Kind, T>& which) {
    T number = 0;
    read(number);
    which = Which<Kind, T>::ofNumber(number);
  }
  /// Each value takes a byte at least, so that a list can't ask for memory that it has no bytes
  /// for.
  template <class T>
  void read(std::vector<T>& list) {
    uint32_t count = 0;
    read(count);
    if (!require(count <= left_.size())) return;
    list.resize(count);
    for (T& value : list)
      if (isGood_) read(value);
  }
  template <class T>
  void read(ResultPlane<T>& plane) {
    Size size;
    read(size);
    if (!require(size.width >= 0 && size.height >= 0 &&
                 std::max(size.width, size.height) <= kLongestSide && size.area() <= kMostPixels))
      return;
    Image<T> pixels(size);
    for (int y = 0; y < size.height && isGood_; ++y)
      readRow<T>({pixels.row(y), static_cast<size_t>(size.width)});
    if (isGood_) plane.takePacked(std::move(pixels));
  }
  template <class T>
  void readRow(std::span<T> row) {
    while (!row.empty() && isGood_) {
      T value = 0;
      uint16_t length = 0;
      read(value);
      read(length);
      if (!require(length > 0 && length <= row.size())) return;
      std::fill_n(row.begin(), length, value);
      row = row.subspan(length);
    }
  }
  template <class T>
  requires std::is_class_v<T>
  void read(T& value) {
    pass(*this, value);
    if constexpr (Like<T, Point> || Like<T, Box>) require(isNear(value.x) && isNear(value.y));
    if constexpr (Like<T, Size> || Like<T, Box>)
      require(value.width >= 0 && value.height >= 0 && isNear(value.width) && isNear(value.height));
  }

  bool require(bool holds) {
    isGood_ = isGood_ && holds;
    return isGood_;
  }

  std::span<const uint8_t> left_;
  bool isGood_ = true;
};

/// A plane that is there has the result's size, and holds no number above `most`.
template <class T>
bool fits(const ResultPlane<T>& plane, Size size, size_t most) {
  if (plane.pixelSize().isEmpty()) return true;
  if (plane.pixelSize() != size) return false;
  std::vector<T> scratch;
  for (int y = 0; y < size.height; ++y) {
    const T* row = plane.unpackedRow(y, scratch);
    if (*std::max_element(row, row + size.width) > most) return false;
  }
  return true;
}

bool isSound(const background::Foreground& result) {
  return fits(result.mask, result.size, UINT8_MAX);
}
bool isSound(const segmentation::Labels& result) {
  return result.count <= UINT16_MAX && fits(result.ids, result.size, result.count) &&
         fits(result.hue, result.size, UINT8_MAX);
}
bool isSound(const graph::Graph& result) {
  const size_t count = result.regions.size();
  return count <= UINT16_MAX &&
         std::all_of(result.arcs.begin(), result.arcs.end(), [&](const graph::Arc& arc) {
           return arc.a && arc.a < arc.b && arc.b.number() <= count;
         });
}
bool isSound(const motion::Motion& result) {
  return result.regions.size() <= UINT16_MAX;
}
bool isSound(const objects::Objects& result) {
  const size_t count = result.regionObject.size();
  return result.regionExpected.size() == count && result.regionGroup.size() == count &&
         (result.ground.empty() || result.ground.size() == count) &&
         fits(result.slots, result.size, result.objects.size()) && result.camera.isSafe();
}

/// What is not there is as if it had been packed: no stage works on it.
template <class Payload>
std::shared_ptr<const Payload> orNothing(std::shared_ptr<const Payload> result) {
  if (result) return result;
  auto nothing = std::make_shared<Payload>();
  if constexpr (requires { nothing->ids; }) nothing->ids.takePacked({});
  if constexpr (requires { nothing->labels; })
    nothing->labels = orNothing<segmentation::Labels>(nullptr);
  return nothing;
}

}  // namespace

template <class Payload>
std::vector<uint8_t> store(const Payload& result) {
  Writer writer;
  pass(writer, result);
  return writer.take();
}

template <class Payload>
std::shared_ptr<Payload> restore(std::span<const uint8_t> bytes) {
  auto result = std::make_shared<Payload>();
  Reader reader(bytes);
  pass(reader, *result);
  return reader.isDone() && isSound(*result) ? result : nullptr;
}

bool join(segmentation::Labels& labels, std::shared_ptr<const background::Foreground> foreground) {
  labels.foreground = std::move(foreground);
  return !labels.foreground || labels.foreground->size == labels.size;
}

bool join(graph::Graph& graph, std::shared_ptr<const segmentation::Labels> labels) {
  const bool fits =
      !labels || (labels->size == graph.size && labels->count == graph.regions.size());
  graph.labels = orNothing(std::move(labels));
  return fits;
}

bool join(motion::Motion& motion, std::shared_ptr<const graph::Graph> graph) {
  const bool fits = !graph || graph->regions.size() == motion.regions.size();
  motion.graph = orNothing(std::move(graph));
  return fits;
}

bool join(objects::Objects& objects, std::shared_ptr<const motion::Motion> motion) {
  const bool fits = !motion || !motion->graph || objects.regionObject.empty() ||
                    (motion->graph->regions.size() == objects.regionObject.size() &&
                     motion->graph->arcs.size() == objects.arcs.size());
  objects.motion = std::move(motion);
  return fits;
}

template std::vector<uint8_t> store(const background::Foreground&);
template std::vector<uint8_t> store(const segmentation::Labels&);
template std::vector<uint8_t> store(const graph::Graph&);
template std::vector<uint8_t> store(const motion::Motion&);
template std::vector<uint8_t> store(const objects::Objects&);
template std::shared_ptr<background::Foreground> restore(std::span<const uint8_t>);
template std::shared_ptr<segmentation::Labels> restore(std::span<const uint8_t>);
template std::shared_ptr<graph::Graph> restore(std::span<const uint8_t>);
template std::shared_ptr<motion::Motion> restore(std::span<const uint8_t>);
template std::shared_ptr<objects::Objects> restore(std::span<const uint8_t>);

}  // namespace rg
