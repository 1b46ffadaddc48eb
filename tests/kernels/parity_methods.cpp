// SPDX-License-Identifier: LGPL-2.1-or-later
// The Gaussian and the difference method, and shadows.
#include "core/base/run.hpp"
#include "tests/kernels/masks.hpp"
#include "tests/kernels/parity.hpp"
#include "tests/kernels/pictures.hpp"

#include <utility>

namespace rg::test {
namespace {

using background::GaussianBackground;

template <class T>
struct ModelPlanes {
  std::array<Plane<T>, 3> planes;
  int channels;
  ModelPlanes(const std::array<Image<T>, 3>& from, int count)
      : planes{Plane<T>(from[0].view()), Plane<T>(from[0].view()), Plane<T>(from[0].view())},
        channels(count) {
    for (size_t c = 0; c < static_cast<size_t>(channels); ++c) planes[c] = Plane<T>(from[c].view());
  }
  operator gpu::PlanesOf<T>() {  // NOLINT(google-explicit-constructor)
    return {{planes[0], planes[1], planes[2]}, channels};
  }
  void expect(const std::array<Image<T>, 3>& expected, const char* what) {
    for (size_t c = 0; c < static_cast<size_t>(channels); ++c)
      planes[c].expect(expected[c].view(), what);
  }
};

struct DeviceGaussian {
  ModelPlanes<uint16_t> means, variances;
  ModelPlanes<uint32_t> sums, squares;
  explicit DeviceGaussian(const GaussianBackground& from)
      : means(from.means, from.channels),
        variances(from.variances, from.channels),
        sums(from.sums, from.channels),
        squares(from.squares, from.channels) {}
  gpu::background::GaussianView view() { return {means, variances, sums, squares}; }
  void expect(const GaussianBackground& expected) {
    means.expect(expected.means, "means");
    variances.expect(expected.variances, "variances");
    sums.expect(expected.sums, "sums");
    squares.expect(expected.squares, "squares");
  }
};

/// Calls check(picture, model) with a model that was trained by some frames before the picture.
template <class Check>
void forTrained(const Check& check) {
  forSizesAndFills([&](Size size, int fill) {
    for (const bool isGrey : {false, true}) {
      Picture picture;
      GaussianBackground model;
      for (int frame = 0; frame < 4; ++frame) {
        loadScene(size, fill, frame, isGrey, picture);
        if (frame == 0) background::startTraining(picture, model);
        if (frame < 3) background::train(picture, oneThread(), model);
      }
      check(picture, model);
    }
  });
}

/// The same, ready for use.
template <class Check>
void forFinished(const Check& check) {
  forTrained([&](const Picture& picture, GaussianBackground& model) {
    background::finishTraining(oneThread(), model);
    check(picture, model);
  });
}

/// Calls check(a, b) with two frames of a scene.
template <class Check>
void forPairs(const Check& check) {
  forSizesAndFills([&](Size size, int fill) {
    for (const bool isGrey : {false, true}) {
      std::pair<Picture, Picture> frames;
      loadScene(size, fill, 0, isGrey, frames.first);
      loadScene(size, fill, 1, isGrey, frames.second);
      check(frames.first, frames.second);
    }
  });
}

Run rowOf(Size size, int y) {
  return runOf(y, 0, size.width);
}

}  // namespace

void parity_train() {
  forTrained([](const Picture& picture, GaussianBackground& model) {
    DeviceGaussian there(model);
    gpu::background::train(planesOf(picture), there.view(), nullptr);
    background::train(picture, oneThread(), model);
    there.expect(model);
  });
}

void parity_finishTraining() {
  forTrained([](const Picture&, GaussianBackground& model) {
    DeviceGaussian there(model);
    gpu::background::finishTraining(model.trainedFrames, there.view(), nullptr);
    background::finishTraining(oneThread(), model);
    there.expect(model);
  });
}

void parity_testGaussian() {
  forFinished([](const Picture& picture, GaussianBackground& model) {
    DeviceGaussian there(model);
    for (const int threshold : {0, 20, 255}) {
      Image<uint8_t> simple, gaussian;
      background::testGaussian(picture, model, threshold, oneThread(), simple, gaussian);
      Plane<uint8_t> simpleThere(picture.size()), gaussianThere(picture.size());
      gpu::background::testGaussian(planesOf(picture), there.view(), threshold,
                                    {simpleThere, gaussianThere}, nullptr);
      simpleThere.expect(simple.view(), "simple");
      gaussianThere.expect(gaussian.view(), "gaussian");
    }
  });
}

void parity_updateGaussian() {
  forFinished([](const Picture& picture, GaussianBackground& model) {
    Image<uint8_t> mask(picture.size());
    mask.fill(0);
    paint(scattered(picture.size(), 3), 128, mask);
    Plane<uint8_t> maskThere(mask.view());
    DeviceGaussian there(model);
    for (const background::UpdateRates& rates :
         {background::UpdateRates{{3, 1}, {8, 1}, 5}, {{1, 1}, {8, 4}, 5}, {{8, 2}, {8, 4}, 8}}) {
      gpu::background::updateGaussian(planesOf(picture), maskThere, rates, there.view(), nullptr);
      background::updateGaussian(picture, mask, rates, oneThread(), model);
      there.expect(model);
    }
  });
}

void parity_paintMean() {
  forFinished([](const Picture& picture, GaussianBackground& model) {
    std::array<Image<uint8_t>, 3> expected;
    background::paintMean(model, oneThread(), expected);
    DeviceGaussian there(model);
    DevicePlanes out(picture.size(), model.channels);
    gpu::background::paintMean(there.view(), out, nullptr);
    out.expect(expected, "means");
  });
}

void parity_findShadows() {
  forPairs([](const Picture& picture, const Picture& other) {
    const Size size = picture.size();
    // The picture is the other one, darker in places.
    Image<uint8_t> darker[3] = {Image<uint8_t>(size), Image<uint8_t>(size), Image<uint8_t>(size)};
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) {
        const int share = 90 + 40 * (hashOf(x / 16, y / 8, 2) % 5 != 0);
        darker[0].at(x, y) = static_cast<uint8_t>(other.red().at(x, y) * share >> 8);
        darker[1].at(x, y) = static_cast<uint8_t>(other.green().at(x, y) * share >> 8);
        darker[2].at(x, y) =
            static_cast<uint8_t>((x / 9 % 3 == 0 ? picture : other).blue().at(x, y) * share >> 8);
      }
    const background::ColourPlanes planes{darker[0], darker[1], darker[2]};
    const BitMask mask = scattered(size, 8);
    BitMask expected(size);
    background::findShadows(planes, background::planesOf(other), mask, oneThread(), expected);
    Bits out(size);
    gpu::background::findShadows(planes, background::planesOf(other), Bits(mask), out, nullptr);
    out.expect(expected, "shadow");
  });
}

void parity_measureChange() {
  forPairs([](const Picture& a, const Picture& b) {
    Image<uint8_t> expected(a.size());
    for (int y = 0; y < a.size().height; ++y)
      background::measureChange(background::planesOf(a), background::planesOf(b),
                                rowOf(a.size(), y), expected.row(y));
    Plane<uint8_t> out(a.size());
    gpu::background::measureChange(planesOf(a), planesOf(b), out, nullptr);
    out.expect(expected.view(), "difference");
  });
}

void parity_differ() {
  forPairs([](const Picture& a, const Picture& b) {
    Image<uint8_t> expected;
    background::differ(a, b, oneThread(), expected);
    Plane<uint8_t> out(a.size());
    gpu::background::differ(planesOf(a), planesOf(b), out, nullptr);
    out.expect(expected.view(), "difference");
  });
}

namespace {

/// A plane of 0 and 255, dense or with few pixels set.
Image<uint8_t> binary(Size size, uint32_t what) {
  Image<uint8_t> plane(size);
  plane.fill(0);
  paint(what % 2 == 0 ? scattered(size, what) : maskOf(size, kMasks - 1), 255, plane);
  return plane;
}

}  // namespace

void parity_keepAbove() {
  forSizesAndFills([](Size size, int fill) {
    for (const int threshold : {0, 12, 254, 255}) {
      Image<uint8_t> plane = filled(size, fill);
      Plane<uint8_t> there(std::as_const(plane).view());
      gpu::background::keepAbove(&threshold, there, nullptr);
      background::keepAbove(threshold, oneThread(), plane);
      there.expect(std::as_const(plane).view(), "above");
    }
  });
}

void parity_keepBoth() {
  for (const Size size : kSizes) {
    const Image<uint8_t> a = binary(size, 2), b = binary(size, 4);
    Image<uint8_t> expected(size);
    background::keepBoth(a, b, oneThread(), expected);
    Plane<uint8_t> out(size);
    gpu::background::keepBoth(Plane<uint8_t>(a.view()), Plane<uint8_t>(b.view()), out, nullptr);
    out.expect(std::as_const(expected).view(), "both");
  }
}

void parity_joinFound() {
  for (const Size size : kSizes) {
    background::GaussianTests tests{binary(size, 2), binary(size, 4), Image<uint8_t>(size)};
    background::keepBoth(tests.simple, tests.gaussian, oneThread(), tests.common);
    const Image<uint8_t> lines = binary(size, 6);
    Image<uint8_t> expected(size);
    background::joinFound(tests, lines, oneThread(), expected);
    Plane<uint8_t> simple(std::as_const(tests.simple).view()),
        gaussian(std::as_const(tests.gaussian).view()), common(std::as_const(tests.common).view()),
        between(lines.view()), out(size);
    gpu::background::joinFound({simple, gaussian, common}, between, out, nullptr);
    out.expect(std::as_const(expected).view(), "found");
  }
}

/// Boxes of one pixel, of whole frames, of several strips, and some that overlap.
void parity_fillLines() {
  for (const Size size : kSizes)
    for (const uint32_t what : {1u, 2u}) {
      const Image<uint8_t> edges = binary(size, what);
      Image<uint8_t> expected(size);
      expected.fill(0);
      background::CleaningScratch scratch;
      gpu::background::LineList list;
      const Box frame = boundsOf(size);
      double pixels = 0;
      for (const Box& wanted :
           {frame, Box{0, 0, 1, 1}, Box{size.width / 3, size.height / 4, 40, 40},
            Box{size.width / 2, 0, 7, size.height}, Box{3, 3, 70, 2}}) {
        const Box box = what == 1 && wanted == frame ? Box{1, 1, 60, 60} : wanted;
        const Box inside = intersect(box, frame);
        if (inside.isEmpty()) continue;
        background::fillLines(edges, inside, scratch, expected);
        list.add(inside);
        pixels += static_cast<double>(inside.area());
      }
      list.add({0, 0, 1, size.height});
      background::fillLines(edges, {0, 0, 1, size.height}, scratch, expected);
      Guarded<uint32_t> reaches(std::vector<uint32_t>(list.reaches, 0xA5A5A5A5u), 0x5A5A5A5Au);
      Image<uint8_t> nothing(size);
      nothing.fill(0);
      Plane<uint8_t> from(edges.view()), out(std::as_const(nothing).view());
      gpu::background::fillLines(
          from,
          {list.boxes.data(), list.strips.data(), static_cast<int>(list.strips.size()),
           reaches.data(), list.reaches, pixels},
          out, nullptr);
      out.expect(std::as_const(expected).view(), "filled");
      reaches.expectGuarded();
    }
}

}  // namespace rg::test
