// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/methods/paper_operations.hpp"

#include "core/background/background.hpp"
#include "core/background/models/frame_difference.hpp"
#include "core/background/shadows/shadow.hpp"
#include "core/base/histogram.hpp"

namespace rg::background {

void PaperOperations::train(const Picture& picture, GaussianBackground& model) {
  background::train(picture, executor_, model);
}

void PaperOperations::finishTraining(GaussianBackground& model) {
  background::finishTraining(executor_, model);
}

void PaperOperations::testGaussian(const Picture& picture, const GaussianBackground& model,
                                   int threshold, GaussianTests& tests) {
  background::testGaussian(picture, model, threshold, executor_, tests.simple, tests.gaussian);
  keepBoth(tests.simple, tests.gaussian, executor_, tests.common);
}

void PaperOperations::findEdges(const Picture& picture, const Picture& previous, int leastEdge,
                                Image<uint8_t>& edges) {
  differ(picture, previous, executor_, edges);
  keepAbove(differenceThreshold(countLevels(edges, executor_), leastEdge), executor_, edges);
}

void PaperOperations::fillAreas(const Image<uint8_t>& common, const Image<uint8_t>& edges,
                                Image<uint8_t>& filled) {
  filled.fill(0);
  findComponents(common, 255, Connectivity::Eight, areas_);
  choosePartsToFill(areas_.list, edges.size(), chosen_);
  for (const uint32_t part : chosen_) fillLines(edges, areas_.list[part].box, scratch_, filled);
}

void PaperOperations::joinFound(const GaussianTests& tests, const Image<uint8_t>& filled,
                                Image<uint8_t>& mask) {
  background::joinFound(tests, filled, executor_, mask);
}

void PaperOperations::markShadows(const Picture& picture, const GaussianBackground& model,
                                  Image<uint8_t>& mask) {
  paintMean(model, executor_, mean_);
  const bool isGrey = model.channels == 1;
  const ColourPlanes background{mean_[isGrey ? 0 : 1], mean_[0], mean_[isGrey ? 0 : 2]};
  const ColourPlanes planes{picture.red(), picture.green(), picture.blue()};
  shadow_.resize(mask.size());
  packEqual(mask, kForegroundPixel, found_);
  findShadows(planes, background, found_, executor_, shadow_);
  paint(shadow_, kShadowPixel, mask);
}

void PaperOperations::updateGaussian(const Picture& picture, const Image<uint8_t>& mask,
                                     const UpdateRates& rates, GaussianBackground& model) {
  background::updateGaussian(picture, mask, rates, executor_, model);
}

}  // namespace rg::background
