// SPDX-License-Identifier: LGPL-2.1-or-later
// Components against OpenCV's, which number them in the same order.
#include "core/base/components.hpp"
#include "core/base/pixel.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace rg {
namespace {

void expectSame(const Image<uint8_t>& mask, Connectivity connectivity) {
  Components found;
  findComponents(mask, 255, connectivity, found);
  cv::Mat copy(mask.height(), mask.width(), CV_8UC1);
  for (int y = 0; y < mask.height(); ++y)
    std::copy_n(mask.row(y), mask.width(), copy.ptr<uint8_t>(y));
  cv::Mat labels, statistics, centroids;
  const int count = cv::connectedComponentsWithStats(copy, labels, statistics, centroids,
                                                     connectivity == Connectivity::Four ? 4 : 8);
  ASSERT_EQ(found.list.size(), static_cast<size_t>(count - 1));
  // OpenCV's numbers follow its blocks of 2x2: what holds the same pixels is the same.
  for (const ComponentRun& run : found.runs) {
    const int label = labels.at<int>(run.y, run.begin);
    for (int x = run.begin; x < run.end; ++x) ASSERT_EQ(labels.at<int>(run.y, x), label);
    const Component& component = found.list[run.component];
    ASSERT_EQ(component.areaPx, static_cast<uint32_t>(statistics.at<int>(label, cv::CC_STAT_AREA)));
    ASSERT_EQ(component.box, (Box{statistics.at<int>(label, cv::CC_STAT_LEFT),
                                  statistics.at<int>(label, cv::CC_STAT_TOP),
                                  statistics.at<int>(label, cv::CC_STAT_WIDTH),
                                  statistics.at<int>(label, cv::CC_STAT_HEIGHT)}));
  }
}

TEST(ComponentsPeer, OpenCvFindsTheSame) {
  for (const Size size : {Size{1, 1}, Size{63, 5}, Size{64, 64}, Size{65, 31}, Size{257, 40}})
    for (const uint32_t share : {20u, 41u, 60u, 85u})
      for (const Connectivity connectivity : {Connectivity::Four, Connectivity::Eight}) {
        Image<uint8_t> mask(size);
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x)
            mask.at(x, y) =
                mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), share) % 100 < share
                    ? 255
                    : 0;
        expectSame(mask, connectivity);
      }
}

}  // namespace
}  // namespace rg
