// SPDX-License-Identifier: LGPL-2.1-or-later
// What operations do with images: on a device they get views of its memory, before the CPU does
// them the images come to the host.
#pragma once

#include "core/background/methods/difference_operations.hpp"
#include "core/background/methods/paper_operations.hpp"
#include "core/background/operations.hpp"
#include "core/base/bit_mask.hpp"
#include "core/base/memory/image.hpp"
#include "kernels/consensus_background.hpp"
#include "kernels/ghosts.hpp"
#include "kernels/views.hpp"

#include <concepts>
#include <cstddef>
#include <type_traits>

namespace rg::gpu {

template <class T, class Plain>
concept Of = std::same_as<std::remove_const_t<T>, Plain>;

/// Visits the images that something consists of.
template <class T, class Visit>
void forImages(const Image<T>& image, const Visit& visit) {
  visit(image);
}
template <class T, class Visit>
void forImages(Image<T>& image, const Visit& visit) {
  visit(image);
}
template <Of<BitMask> T, class Visit>
void forImages(T& mask, const Visit& visit) {
  visit(mask.words());
}
template <Of<rg::background::ShownModel> T, class Visit>
void forImages(T& shown, const Visit& visit) {
  for (auto& plane : shown) visit(plane);
}
template <Of<rg::background::SmoothPicture> T, class Visit>
void forImages(T& picture, const Visit& visit) {
  forImages(picture.planes, visit);
}
template <Of<rg::background::ConsensusBackground> T, class Visit>
void forImages(T& model, const Visit& visit) {
  for (auto* image : {&model.samples, &model.noise, &model.unrest}) visit(*image);
}
template <Of<rg::background::Verdicts> T, class Visit>
void forImages(T& verdicts, const Visit& visit) {
  for (auto* mask : {&verdicts.raw, &verdicts.strong, &verdicts.faint}) visit(mask->words());
}
template <Of<rg::background::StillPixels> T, class Visit>
void forImages(T& still, const Visit& visit) {
  for (auto& plane : still.colours) visit(plane);
  visit(still.ages);
  visit(still.aged.words());
  visit(still.fresh);
}
template <Of<rg::background::GaussianBackground> T, class Visit>
void forImages(T& model, const Visit& visit) {
  for (size_t c = 0; c < 3; ++c) {
    visit(model.means[c]);
    visit(model.variances[c]);
    visit(model.sums[c]);
    visit(model.squares[c]);
  }
}
template <Of<rg::background::GaussianTests> T, class Visit>
void forImages(T& tests, const Visit& visit) {
  for (auto* image : {&tests.simple, &tests.gaussian, &tests.common}) visit(*image);
}
template <Of<rg::background::SceneMemory> T, class Visit>
void forImages(T& memory, const Visit& visit) {
  for (auto& plane : memory.images().seen) visit(plane);
  visit(memory.images().known);
}
template <Of<rg::background::CellSearch> T, class Visit>
void forImages(T& search, const Visit& visit) {
  visit(search.pixels());
  visit(search.seeds());
}

/// What the CPU is about to read, to change, to write anew.
template <class T>
struct Reads {
  const T& what;
  void bringToHost() const {
    forImages(what, [](const auto& image) { image.readOnHost(); });
  }
};
/// Of an image that need not be there.
template <class T>
struct ReadsIfAny {
  const T* what;
  void bringToHost() const {
    if (what != nullptr) Reads<T>{*what}.bringToHost();
  }
};
template <class T>
struct Changes {
  T& what;
  void bringToHost() const {
    forImages(what, [](auto& image) { image.changeOnHost(); });
  }
};
template <class T>
struct Writes {
  T& what;
  void bringToHost() const {
    forImages(what, [](auto& image) { image.writeOnHost(); });
  }
};
template <class T>
Reads(const T&) -> Reads<T>;
template <class T>
ReadsIfAny(const T*) -> ReadsIfAny<T>;
template <class T>
Changes(T&) -> Changes<T>;
template <class T>
Writes(T&) -> Writes<T>;

/// The same on a device. They throw DeviceError.
class Access {
 public:
  explicit Access(Device& device) : device_(device) {}

  [[nodiscard]] BitView read(const BitMask& mask) const {
    return {mask.words().readOn(device_), mask.size()};
  }
  [[nodiscard]] BitTarget change(BitMask& mask) const {
    return {mask.words().changeOn(device_), mask.size()};
  }
  /// Takes the size first.
  [[nodiscard]] BitTarget write(BitMask& mask, Size size) const {
    mask.resize(size);
    return {mask.words().writeOn(device_), size};
  }

  [[nodiscard]] Planes read(const Picture& picture) const {
    const Picture::Planes planes = picture.readOn(device_);
    return {{planes.green, planes.red, planes.blue}, picture.isGrey() ? 1 : 3};
  }
  /// The same, red first.
  [[nodiscard]] Planes readRed(const Picture& picture) const {
    const Picture::Planes planes = picture.readOn(device_);
    return {{planes.red, planes.green, planes.blue}, picture.isGrey() ? 1 : 3};
  }
  [[nodiscard]] Planes read(const rg::background::SmoothPicture& picture) const {
    return read(picture.planes, picture.channels);
  }
  [[nodiscard]] PlaneTargets write(rg::background::SmoothPicture& picture, Size size,
                                   int channels) const {
    picture.channels = channels;
    return write(picture.planes, size, channels);
  }
  [[nodiscard]] PlaneTargets change(rg::background::SmoothPicture& picture) const {
    PlaneTargets views{{}, picture.channels};
    for (int c = 0; c < picture.channels; ++c)
      views.planes[c] = picture.planes[at(c)].changeOn(device_);
    return views;
  }
  [[nodiscard]] Planes read(const rg::background::ShownModel& planes, int channels) const {
    Planes views{{}, channels};
    for (int c = 0; c < channels; ++c) views.planes[c] = planes[at(c)].readOn(device_);
    return views;
  }
  [[nodiscard]] PlaneTargets write(rg::background::ShownModel& planes, Size size,
                                   int channels) const {
    PlaneTargets views{{}, channels};
    for (int c = 0; c < channels; ++c) {
      planes[at(c)].resize(size);
      views.planes[c] = planes[at(c)].writeOn(device_);
    }
    return views;
  }

  [[nodiscard]] ImageView<uint8_t> write(Image<uint8_t>& image) const {
    return image.writeOn(device_);
  }
  [[nodiscard]] background::VerdictTargets write(rg::background::Verdicts& out, Size size) const {
    return {write(out.raw, size), write(out.strong, size), write(out.faint, size)};
  }

  /// For kernels that only look how old pixels are.
  [[nodiscard]] background::StillView read(const rg::background::StillPixels& still) const {
    return {{}, readOnly(still.ages), {}, {}};
  }
  [[nodiscard]] background::StillView change(rg::background::StillPixels& still,
                                             int channels) const {
    PlaneTargets colours{{}, channels};
    for (int c = 0; c < channels; ++c) colours.planes[c] = still.colours[at(c)].changeOn(device_);
    return {colours, still.ages.changeOn(device_), change(still.aged),
            still.fresh.changeOn(device_)};
  }

  /// For kernels that only read it.
  [[nodiscard]] background::ModelView read(const rg::background::ConsensusBackground& model) const {
    return {model.noise.size(), model.channels, readOnly(model.samples), readOnly(model.noise),
            readOnly(model.unrest)};
  }
  [[nodiscard]] background::ModelView change(rg::background::ConsensusBackground& model) const {
    return {model.noise.size(), model.channels, model.samples.changeOn(device_),
            model.noise.changeOn(device_), model.unrest.changeOn(device_)};
  }
  [[nodiscard]] background::ModelView write(rg::background::ConsensusBackground& model) const {
    return {model.noise.size(), model.channels, model.samples.writeOn(device_),
            model.noise.writeOn(device_), model.unrest.writeOn(device_)};
  }

 private:
  static size_t at(int channel) { return static_cast<size_t>(channel); }
  template <class T>
  [[nodiscard]] ImageView<T> readOnly(const Image<T>& image) const {
    const ImageView<const T> view = image.readOn(device_);
    return {const_cast<T*>(view.data), view.size, view.strideBytes};
  }

  Device& device_;
};

}  // namespace rg::gpu
