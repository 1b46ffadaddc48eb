// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/mask_cleaning.hpp"
#include "kernels/cast_shadows.hpp"
#include "kernels/primitives.hpp"
#include "kernels/shim/block.hpp"
#include "tests/kernels/parity.hpp"

#include <numeric>
#include <vector>

namespace rg::test {
namespace {

/// Masks that are hard on components: full, empty, dots that touch by corners only, combs whose
/// teeth meet in the last row, spirals of one pixel, patches.
constexpr int kMasks = 8;
BitMask maskOf(Size size, int kind) {
  BitMask mask(size);
  mask.clear();
  const auto isSet = [&](int x, int y) {
    const int ring = std::min(std::min(x, size.width - 1 - x), std::min(y, size.height - 1 - y));
    switch (kind) {
      case 0:
        return true;
      case 1:
        return false;
      case 2:
        return (x + y) % 2 == 0;
      case 3:
        return x % 2 == 0 || y == size.height - 1;
      case 4:
        return ring % 2 == 0 && !(x == ring && y == ring + 1);
      case 5:
        return hashOf(x, y, 1) % 2 == 0;
      case 6:
        return hashOf(x / 7, y / 3, 2) % 3 != 0;
      default:
        return hashOf(x, y, 3) % 40 == 0;
    }
  };
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      if (isSet(x, y)) mask.set(x, y);
  return mask;
}

template <class Check>
void forMasks(const Check& check) {
  for (const Size size : kSizes)
    for (int kind = 0; kind < kMasks && !::testing::Test::HasFailure(); ++kind) {
      SCOPED_TRACE(std::to_string(size.width) + "x" + std::to_string(size.height) + ", mask " +
                   std::to_string(kind));
      check(maskOf(size, kind));
    }
}

struct DeviceComponents {
  std::vector<ComponentRun> runs;
  std::vector<Component> list;
  std::vector<uint32_t> parents, numbers, firstRun, firstRoot, scratch;

  explicit DeviceComponents(Size size) {
    const auto most = static_cast<size_t>(gpu::mostRuns(size));
    const int words = gpu::wordsOf(size.width) * size.height;
    runs.resize(most);
    list.resize(most);
    for (std::vector<uint32_t>* numbersOfRuns : {&parents, &numbers})
      numbersOfRuns->assign(most, 0xA5A5A5A5);
    for (std::vector<uint32_t>* ofWords : {&firstRun, &firstRoot})
      ofWords->assign(static_cast<size_t>(words) + 1, 0xA5A5A5A5);
    scratch.assign(static_cast<size_t>(gpu::scanScratchOf(words)) + 1, 0xA5A5A5A5);
  }
  gpu::ComponentsView view() {
    return {runs.data(),     list.data(),      parents.data(), numbers.data(),
            firstRun.data(), firstRoot.data(), scratch.data()};
  }
};

void expectSame(const DeviceComponents& found, const Components& expected) {
  ASSERT_EQ(found.firstRun.back(), expected.runs.size());
  ASSERT_EQ(found.firstRoot.back(), expected.list.size());
  for (size_t i = 0; i < expected.runs.size(); ++i) {
    ASSERT_EQ(static_cast<const Run&>(found.runs[i]), static_cast<const Run&>(expected.runs[i]));
    ASSERT_EQ(found.runs[i].component, expected.runs[i].component) << "run " << i;
  }
  for (size_t i = 0; i < expected.list.size(); ++i) {
    ASSERT_EQ(found.list[i].box, expected.list[i].box) << "component " << i;
    ASSERT_EQ(found.list[i].areaPx, expected.list[i].areaPx) << "component " << i;
    ASSERT_EQ(found.list[i].firstPixel, expected.list[i].firstPixel) << "component " << i;
  }
}

}  // namespace

void parity_packEqual() {
  forMasks([](const BitMask& mask) {
    Image<uint8_t> bytes(mask.size());
    bytes.fill(127);
    paint(mask, 128, bytes);
    Plane<uint8_t> there(bytes.view());
    Bits out(mask.size());
    gpu::packEqual(there, 128, out, nullptr);
    out.expect(mask, "packed");
  });
}

void parity_paint() {
  forMasks([](const BitMask& mask) {
    Image<uint8_t> expected(mask.size());
    expected.fill(7);
    Plane<uint8_t> there(expected.view());
    paint(mask, 128, expected);
    gpu::paint(Bits(mask), 128, there, nullptr);
    there.expect(expected.view(), "painted");
  });
}

void parity_remove() {
  forMasks([](const BitMask& mask) {
    BitMask expected = scattered(mask.size(), 4);
    Bits there(expected);
    remove(mask, expected);
    gpu::remove(Bits(mask), there, nullptr);
    there.expect(expected, "rest");
  });
}

void parity_keepOnly() {
  forMasks([](const BitMask& mask) {
    BitMask expected = scattered(mask.size(), 4);
    Bits there(expected);
    keepOnly(mask, expected);
    gpu::keepOnly(Bits(mask), there, nullptr);
    there.expect(expected, "rest");
  });
}

void parity_thicken() {
  forMasks([](const BitMask& mask) {
    for (const int margin : {1, 2, 9, 63}) {
      BitMask across, expected;
      thicken(mask, margin, oneThread(), across, expected);
      Bits out(mask.size());
      gpu::thicken(Bits(mask), margin, out, nullptr);
      out.expect(expected, "thick");
    }
  });
}

void parity_findComponents() {
  forMasks([](const BitMask& mask) {
    for (const Connectivity connectivity : {Connectivity::Four, Connectivity::Eight})
      for (const bool value : {false, true}) {
        Components expected;
        findComponents(mask, value, connectivity, expected);
        DeviceComponents found(mask.size());
        gpu::findComponents(Bits(mask), value, connectivity, found.view(), nullptr);
        expectSame(found, expected);
      }
  });
}

void parity_keepMajority() {
  forMasks([](const BitMask& mask) {
    for (const int radius : {1, 2, 3, 7})
      for (const int share : {115, 128, 255}) {
        background::CleaningScratch scratch;
        BitMask expected(mask.size());
        background::keepMajority(mask, radius, share, oneThread(), scratch, expected);
        Bits out(mask.size());
        gpu::background::keepMajority(Bits(mask), radius, share, out, nullptr);
        out.expect(expected, "majority");
      }
  });
}

void parity_dropSmallParts() {
  forMasks([](BitMask mask) {
    Bits there(mask);
    background::CleaningScratch scratch;
    DeviceComponents found(mask.size());
    gpu::background::dropSmallParts(there, 4, found.view(), nullptr);
    background::dropSmallParts(mask, 4, scratch);
    there.expect(mask, "large parts");
  });
}

void parity_fillHoles() {
  forMasks([](BitMask mask) {
    Bits there(mask);
    background::CleaningScratch scratch;
    DeviceComponents found(mask.size());
    gpu::background::fillHoles(there, 5, found.view(), nullptr);
    background::fillHoles(mask, 5, scratch);
    there.expect(mask, "without holes");
  });
}

void parity_keepSupported() {
  forMasks([](BitMask mask) {
    const BitMask strong = scattered(mask.size(), 9);
    Bits there(mask);
    background::CleaningScratch scratch;
    DeviceComponents found(mask.size());
    gpu::background::keepSupported(there, Bits(strong), 3, found.view(), nullptr);
    background::keepSupported(mask, strong, 3, scratch);
    there.expect(mask, "supported");
  });
}

void parity_keepCastShadows() {
  forMasks([](const BitMask& mask) {
    // Darkened patches of it, some of them cut by its gaps.
    BitMask dark = scattered(mask.size(), 11);
    keepOnly(mask, dark);
    Bits there(dark);
    background::CastShadowScratch scratch;
    DeviceComponents found(mask.size());
    std::vector<background::DarkPart> parts(found.runs.size());
    std::vector<uint32_t> darkOf(found.runs.size(), 0xA5A5A5A5);
    gpu::background::keepCastShadows(Bits(mask), there, {found.view(), parts.data(), darkOf.data()},
                                     nullptr);
    background::keepCastShadows(mask, dark, scratch);
    there.expect(dark, "cast");
  });
}

}  // namespace rg::test

namespace rg {

TEST(Primitives, AScanSumsWhatStandsBefore) {
  for (const int count : {1, 31, 1024, 1025, 5000, 300000}) {
    gpu::shim::begin({gpu::shim::Order::Random, 3});
    std::vector<uint32_t> numbers(static_cast<size_t>(count)), sums(numbers.size() + 1, 9);
    for (size_t i = 0; i < numbers.size(); ++i)
      numbers[i] = test::hashOf(static_cast<int>(i), 0, 1);
    std::vector<uint32_t> expected(sums.size());
    std::partial_sum(numbers.begin(), numbers.end(), expected.begin() + 1);
    std::vector<uint32_t> scratch(static_cast<size_t>(gpu::scanScratchOf(count)) + 1);
    gpu::scan(numbers.data(), count, sums.data(), scratch.data(), nullptr);
    ASSERT_EQ(sums, expected) << count;
    sums.assign(numbers.begin(), numbers.end());
    sums.push_back(9);
    gpu::scan(sums.data(), count, sums.data(), scratch.data(), nullptr);
    ASSERT_EQ(sums, expected) << count << " in place";
    ASSERT_TRUE(gpu::shim::findings().empty()) << gpu::shim::findings().front();
  }
}

}  // namespace rg
