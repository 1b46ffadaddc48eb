// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/methods/paper_operations.hpp"

#include "core/background/background.hpp"
#include "core/base/histogram.hpp"
#include "kernels/backend/dispatcher.hpp"
#include "kernels/bit_mask.hpp"
#include "kernels/changed_pixels.hpp"
#include "kernels/gaussian_background.hpp"
#include "kernels/histogram.hpp"
#include "kernels/paper_masks.hpp"
#include "kernels/shadow.hpp"
#include "kernels/thresholds.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace rg::gpu::background {
namespace {

using rg::background::GaussianBackground;
using rg::background::GaussianTests;
using Cpu = rg::background::PaperOperations;

class PaperOnDevice final : public Cpu, private Dispatcher {
 public:
  PaperOnDevice(GpuDevice& device, const Executor& executor) : Cpu(executor), Dispatcher(device) {}

  void train(const Picture& picture, GaussianBackground& model) override {
    run(
        [&] {
          const Planes from = on().read(picture);
          background::train(from, {{}, {}, change(model.sums), change(model.squares)}, stream());
          ++model.trainedFrames;
        },
        [&] { Cpu::train(picture, model); }, Changes{model});
  }
  void finishTraining(GaussianBackground& model) override {
    run(
        [&] {
          const PlanesOf<uint32_t> sums = read(model.sums), squares = read(model.squares);
          const GaussianView view{write(model.means), write(model.variances), sums, squares};
          background::finishTraining(model.trainedFrames, view, stream());
        },
        [&] { Cpu::finishTraining(model); }, Changes{model});
  }
  void testGaussian(const Picture& picture, const GaussianBackground& model, int threshold,
                    GaussianTests& tests) override {
    run(
        [&] {
          const Planes from = on().read(picture);
          const rg::gpu::background::GaussianTests out{on().write(tests.simple),
                                                       on().write(tests.gaussian)};
          background::testGaussian(from, readMeans(model), threshold, out, stream());
          background::keepBoth(out.simple, out.gaussian, on().write(tests.common), stream());
        },
        [&] { Cpu::testGaussian(picture, model, threshold, tests); }, Reads{model}, Writes{tests});
  }
  void findEdges(const Picture& picture, const Picture& previous, int leastEdge,
                 Image<uint8_t>& edges) override {
    const auto onDevice = [&] {
      auto* counts = scratch().take<Histogram>(1);
      auto* threshold = scratch().take<int>(1);
      const Planes from = on().read(picture), before = on().read(previous);
      edges.resize(from.size());
      const ImageView<uint8_t> out = on().write(edges);
      differ(from, before, out, stream());
      rg::gpu::countLevels(out, counts->data(), stream());
      rg::gpu::differenceThreshold(counts->data(), leastEdge, threshold, stream());
      keepAbove(threshold, out, stream());
    };
    run(
        onDevice, [&] { Cpu::findEdges(picture, previous, leastEdge, edges); }, Writes{edges});
  }
  void fillAreas(const Image<uint8_t>& common, const Image<uint8_t>& edges,
                 Image<uint8_t>& filled) override {
    run([&] { fillOnDevice(common, edges, filled); },
        [&] { Cpu::fillAreas(common, edges, filled); }, Reads{common}, Reads{edges},
        Writes{filled});
  }
  void joinFound(const GaussianTests& tests, const Image<uint8_t>& filled,
                 Image<uint8_t>& mask) override {
    run(
        [&] {
          const PaperTests from{tests.simple.readOn(device()), tests.gaussian.readOn(device()),
                                tests.common.readOn(device())};
          const ImageView<const uint8_t> between = filled.readOn(device());
          background::joinFound(from, between, on().write(mask), stream());
        },
        [&] { Cpu::joinFound(tests, filled, mask); }, Reads{tests}, Reads{filled}, Writes{mask});
  }
  void markShadows(const Picture& picture, const GaussianBackground& model,
                   Image<uint8_t>& mask) override {
    run([&] { markShadowsOnDevice(picture, model, mask); },
        [&] { Cpu::markShadows(picture, model, mask); }, Reads{model}, Changes{mask});
  }
  void updateGaussian(const Picture& picture, const Image<uint8_t>& mask,
                      const rg::background::UpdateRates& rates,
                      GaussianBackground& model) override {
    run(
        [&] {
          const Planes from = on().read(picture);
          const ImageView<const uint8_t> foreground = mask.readOn(device());
          const GaussianView view{change(model.means), change(model.variances), {}, {}};
          background::updateGaussian(from, foreground, rates, view, stream());
        },
        [&] { Cpu::updateGaussian(picture, mask, rates, model); }, Reads{mask}, Changes{model});
  }
  void publish(Image<uint8_t>& mask) override {
    onHost([] {}, Changes{mask});
  }

 private:
  /// viewOf(image) of the planes that there are.
  template <class Images, class View>
  [[nodiscard]] static auto each(Images& images, const View& viewOf) {
    using T = std::remove_pointer_t<decltype(viewOf(images[0]).data)>;
    PlanesOf<T> planes{{}, images[1].size().isEmpty() ? 1 : 3};
    for (int c = 0; c < planes.channels; ++c)
      planes.planes[c] = viewOf(images[static_cast<size_t>(c)]);
    return planes;
  }
  template <class T>
  [[nodiscard]] PlanesOf<T> change(std::array<Image<T>, 3>& images) const {
    return each(images, [&](Image<T>& image) { return image.changeOn(device()); });
  }
  template <class T>
  [[nodiscard]] PlanesOf<T> write(std::array<Image<T>, 3>& images) const {
    return each(images, [&](Image<T>& image) { return image.writeOn(device()); });
  }
  /// For kernels that only read.
  template <class T>
  [[nodiscard]] PlanesOf<T> read(const std::array<Image<T>, 3>& images) const {
    return each(images, [&](const Image<T>& image) {
      const ImageView<const T> view = image.readOn(device());
      return ImageView<T>{const_cast<T*>(view.data), view.size, view.strideBytes};
    });
  }
  [[nodiscard]] GaussianView readMeans(const GaussianBackground& model) const {
    return {read(model.means), read(model.variances), {}, {}};
  }

  void fillOnDevice(const Image<uint8_t>& common, const Image<uint8_t>& edges,
                    Image<uint8_t>& filled) {
    const Size size = edges.size();
    const BitTarget bits = scratchMask(size);
    packEqual(common.readOn(device()), 255, bits, stream());
    const ComponentsView found = components(size);
    findComponents(bits, true, Connectivity::Eight, found, stream());
    constexpr int kFewParts = 512;
    const auto expected = static_cast<uint32_t>(std::min<int64_t>(kFewParts, mostRuns(size)));
    fetchCounted(CountedList<Component>{found.firstRoot + bits.words.size.area(), found.list,
                                        expected, parts_});
    rg::background::choosePartsToFill(parts_, size, chosen_);
    lines_.clear();
    int64_t pixels = 0;
    for (const uint32_t part : chosen_) {
      lines_.add(parts_[part].box);
      pixels += parts_[part].box.area();
    }
    const ImageView<const uint8_t> from = edges.readOn(device());
    const ImageView<uint8_t> out = on().write(filled);
    clear(out);
    if (chosen_.empty()) return;
    const LineBoxes boxes{sent(lines_.boxes),
                          sent(lines_.strips),
                          static_cast<int>(lines_.strips.size()),
                          scratch().take<uint32_t>(lines_.reaches),
                          lines_.reaches,
                          static_cast<double>(pixels)};
    fillLines(from, boxes, out, stream());
  }

  void markShadowsOnDevice(const Picture& picture, const GaussianBackground& model,
                           Image<uint8_t>& mask) {
    const Size size = picture.size();
    const PlaneTargets mean = scratchPlanes(size, model.channels);
    paintMean(readMeans(model), mean, stream());
    const BitTarget found = scratchMask(size), shadow = scratchMask(size);
    packEqual(mask.readOn(device()), rg::background::kForegroundPixel, found, stream());
    background::findShadows(coloursOf(on().read(picture)), coloursOf(mean), found, shadow,
                            stream());
    paint(shadow, rg::background::kShadowPixel, mask.changeOn(device()), stream());
  }

  std::vector<Component> parts_;
  std::vector<uint32_t> chosen_;
  LineList lines_;
};

}  // namespace
}  // namespace rg::gpu::background

template <>
std::unique_ptr<rg::background::PaperOperations> rg::gpu::operationsOn(GpuDevice& device,
                                                                       const Executor& executor) {
  return std::make_unique<background::PaperOnDevice>(device, executor);
}
