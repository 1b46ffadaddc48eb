// SPDX-License-Identifier: LGPL-2.1-or-later
// The cascades of Debian's opencv-data in our windows against OpenCV's own detector: the same
// windows are rejected by the same stage with the same sum, to the last bit.
#include "core/detection/detection.hpp"
#include "core/detection/integral.hpp"
#include "core/detection/judge_windows.hpp"
#include "core/detection/scaled_cascade.hpp"
#include "gst/support/cascade_file.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/objdetect.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace rg::detection {
namespace {

constexpr const char* kFolder = "/usr/share/opencv4/haarcascades/";

/// A window that OpenCV finds: where in the picture at its scale, and the sum of the leaves of the
/// last stage.
struct Found {
  int x = 0, y = 0;
  double sum = 0;
  friend bool operator==(const Found&, const Found&) = default;
  friend bool operator<(const Found& a, const Found& b) {
    return std::tie(a.y, a.x) < std::tie(b.y, b.x);
  }
};

cv::Mat photograph() {
  return cv::imread(RG_SOURCE_ROOT "/examples/result.png", cv::IMREAD_GRAYSCALE);
}

/// Blocks, slopes and noise, whose windows come far in many cascades.
cv::Mat pattern() {
  cv::Mat picture(211, 307, CV_8U);
  cv::RNG random(5);
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      picture.at<uchar>(y, x) =
          cv::saturate_cast<uchar>(100 + 60 * std::sin(x * .21) * std::cos(y * .13) +
                                   ((x / 9 + y / 14) % 2) * 50 + random.gaussian(9));
  return picture;
}

/// A cascade's file without the stages from number `stages` on: OpenCV tells of the windows that
/// pass all stages only.
std::string cutBehind(std::string xml, size_t stages) {
  size_t at = xml.find("<stages>");
  const size_t end = xml.find("</stages>", at);
  for (size_t i = 0; i <= stages; ++i) at = xml.find("<maxWeakCount>", at + 1);
  if (at < end) {
    const size_t first = xml.rfind("<_>", at);
    xml.erase(first, end - first);
  }
  return xml;
}

std::string contentsOf(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Whom OpenCV finds at one scale, which it shrinks the picture by, without grouping. With a single
/// stage it can't tell sums: then it mixes up windows that it finds and those that it does not look
/// into.
std::vector<Found> foundBy(cv::CascadeClassifier& peer, size_t stages, const cv::Mat& picture,
                           int scale) {
  std::vector<cv::Rect> boxes;
  std::vector<int> levels;
  std::vector<double> sums;
  const cv::Size window = peer.getOriginalWindowSize() * scale;
  const double factor = scale > 1 ? scale : 2;
  if (stages > 1)
    peer.detectMultiScale(picture, boxes, levels, sums, factor, 0, 0, window, window, true);
  else
    peer.detectMultiScale(picture, boxes, factor, 0, 0, window, window);
  sums.resize(boxes.size());
  std::vector<Found> found;
  for (size_t i = 0; i < boxes.size(); ++i)
    found.push_back({boxes[i].x / scale, boxes[i].y / scale, sums[i]});
  std::sort(found.begin(), found.end());
  return found;
}

/// Our view of one scale of a picture.
class OurScale {
 public:
  OurScale(const Cascade& cascade, const cv::Mat& picture, int factor)
      : factor_(factor), sums_({picture.cols + 1, picture.rows + 1}), squares_(sums_.size()) {
    const ImageView<const uint8_t> luma{
        picture.data, {picture.cols, picture.rows}, static_cast<ptrdiff_t>(picture.step)};
    sumIntegrals(luma, {sums_, squares_});
    const Scale scale{static_cast<double>(factor),
                      {cascade.window.width * factor, cascade.window.height * factor},
                      1};
    const ptrdiff_t row = sums_.view().strideBytes / ptrdiff_t{sizeof(uint32_t)};
    const ptrdiff_t squareRow = squares_.view().strideBytes / ptrdiff_t{sizeof(double)};
    scaled_ = std::make_unique<ScaledCascade>(cascade, scale, SumLayout{1, 0, row, squareRow});
  }
  [[nodiscard]] float factorAt(int x, int y) const {
    return contrastFactor(scaled_->view().contrast, at(x, y),
                          squares_.row(y * factor_) + x * factor_);
  }
  [[nodiscard]] const uint32_t* at(int x, int y) const {
    return sums_.row(y * factor_) + x * factor_;
  }
  [[nodiscard]] CascadeView view() const { return scaled_->view(); }

 private:
  int factor_;
  Image<uint32_t> sums_;
  Image<double> squares_;
  std::unique_ptr<ScaledCascade> scaled_;
};

/// How far windows come, and by which sum each stage decides.
struct Judged {
  std::vector<double> sums;  ///< Of the stages up to the one that rejects.
  [[nodiscard]] bool passes(const CascadeView& view, size_t stages) const {
    return sums.size() >= stages && sums[stages - 1] >= view.stages[stages - 1].threshold;
  }
};
Judged judge(const OurScale& ours, int x, int y) {
  Judged judged;
  const CascadeView view = ours.view();
  const float factor = ours.factorAt(x, y);
  for (int32_t s = 0; factor != 0 && s < view.stageCount; ++s) {
    judged.sums.push_back(stageSum(view, s, ours.at(x, y), factor));
    if (judged.sums.back() < view.stages[s].threshold) break;
  }
  const int32_t passed = factor == 0 ? 0 : stagesPassed(view, ours.at(x, y), factor, 0);
  EXPECT_EQ(static_cast<size_t>(std::min(passed + 1, view.stageCount)),
            judged.sums.size() + (factor == 0));
  return judged;
}

struct Visited {
  int x, y;
  Judged judged;
};

/// The windows that OpenCV visits: every second one in both directions below scale 2, and behind
/// one that the first stage rejects it leaves the next one out.
std::vector<Visited> visit(const OurScale& ours, Size picture, Size window, int scale) {
  const int step = scale < 2 ? 2 : 1;
  std::vector<Visited> visited;
  for (int y = 0; y + window.height < picture.height + 1; y += step)
    for (int x = 0; x + window.width < picture.width + 1; x += step) {
      visited.push_back({x, y, judge(ours, x, y)});
      const Judged& judged = visited.back().judged;
      if (!judged.sums.empty() && !judged.passes(ours.view(), 1)) x += step;
    }
  return visited;
}

class CascadePeer : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const std::string path = std::string(kFolder) + GetParam();
    auto read = readCascade(path);
    ASSERT_TRUE(read) << read.error().message;
    cascade_ = *std::move(read);
    const std::string xml = contentsOf(path);
    const size_t all = cascade_->stages.size();
    for (const size_t stages : {size_t{1}, size_t{2}, size_t{3}, size_t{5}, size_t{9}, all}) {
      const cv::FileStorage storage(cutBehind(xml, stages),
                                    cv::FileStorage::READ | cv::FileStorage::MEMORY);
      peers_.emplace_back(stages, cv::CascadeClassifier());
      ASSERT_TRUE(peers_.back().second.read(storage.getFirstTopLevelNode()));
    }
  }

  void check(const cv::Mat& picture, int scale) {
    cv::Mat enlarged;
    cv::resize(picture, enlarged, {}, scale, scale, cv::INTER_NEAREST);
    const OurScale ours(*cascade_, enlarged, scale);
    const auto visited = visit(ours, {picture.cols, picture.rows}, cascade_->window, scale);
    ASSERT_GT(visited.size(), 1000u);
    for (auto& [stages, peer] : peers_) {
      std::vector<Found> own;
      for (const Visited& v : visited)
        if (v.judged.passes(ours.view(), stages))
          own.push_back({v.x, v.y, stages > 1 ? v.judged.sums[stages - 1] : 0});
      const auto theirs = foundBy(peer, stages, enlarged, scale);
      ASSERT_EQ(own.size(), theirs.size()) << stages << " stages, scale " << scale;
      ASSERT_EQ(own, theirs) << stages << " stages, scale " << scale;
      if (stages <= 2) {
        EXPECT_GT(own.size(), 10u);
      }
    }
  }

  std::shared_ptr<const Cascade> cascade_;
  std::vector<std::pair<size_t, cv::CascadeClassifier>> peers_;  ///< With so many stages.
};

TEST_P(CascadePeer, DecidesAlikeInAPattern) {
  check(pattern(), 1);
}

TEST_P(CascadePeer, DecidesAlikeInAPatternEnlargedByWholeFactors) {
  check(pattern(), 2);
  check(pattern(), 3);
}

INSTANTIATE_TEST_SUITE_P(
    OpenCvData, CascadePeer,
    ::testing::Values("haarcascade_eye.xml", "haarcascade_eye_tree_eyeglasses.xml",
                      "haarcascade_frontalcatface.xml", "haarcascade_frontalcatface_extended.xml",
                      "haarcascade_frontalface_alt.xml", "haarcascade_frontalface_alt2.xml",
                      "haarcascade_frontalface_alt_tree.xml", "haarcascade_frontalface_default.xml",
                      "haarcascade_fullbody.xml", "haarcascade_lefteye_2splits.xml",
                      "haarcascade_lowerbody.xml", "haarcascade_profileface.xml",
                      "haarcascade_righteye_2splits.xml", "haarcascade_russian_plate_number.xml",
                      "haarcascade_smile.xml", "haarcascade_upperbody.xml"));

class CascadePeerInAPhotograph : public CascadePeer {};

TEST_P(CascadePeerInAPhotograph, DecidesAlikeInItAndEnlarged) {
  const cv::Mat picture = photograph();
  ASSERT_FALSE(picture.empty());
  for (const int scale : {1, 2, 3}) check(picture, scale);
}

INSTANTIATE_TEST_SUITE_P(OpenCvData, CascadePeerInAPhotograph,
                         ::testing::Values("haarcascade_frontalface_default.xml",
                                           "haarcascade_fullbody.xml"));

}  // namespace
}  // namespace rg::detection
