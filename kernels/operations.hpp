// SPDX-License-Identifier: LGPL-2.1-or-later
// Every operation of core on pixels that has a counterpart here: what both are called.
//
// The parity tests walk this list: an operation without core's version, without a kernel or without
// a test does not compile or link. meson reads it too and names a test for each line.
#pragma once

#define RG_GPU_OPERATIONS(X)                                                                \
  X(loadPlanes, rg::loadPlanes, rg::gpu::loadPlanes)                                        \
  X(countLevels, rg::countLevels, rg::gpu::countLevels)                                     \
  X(quantile, rg::quantile, rg::gpu::quantile)                                              \
  X(differenceThreshold, rg::differenceThreshold, rg::gpu::differenceThreshold)             \
  X(contrastThreshold, rg::contrastThreshold, rg::gpu::contrastThreshold)                   \
  X(countSet, rg::countSet, rg::gpu::countSet)                                              \
  X(keepInside, rg::keepInside, rg::gpu::keepInside)                                        \
  X(fillUnedged, rg::fillUnedged, rg::gpu::fillUnedged)                                     \
  X(packEqual, rg::packEqual, rg::gpu::packEqual)                                           \
  X(paint, rg::paint, rg::gpu::paint)                                                       \
  X(remove, rg::remove, rg::gpu::remove)                                                    \
  X(keepOnly, rg::keepOnly, rg::gpu::keepOnly)                                              \
  X(thicken, rg::thicken, rg::gpu::thicken)                                                 \
  X(findComponents, rg::findComponents, rg::gpu::findComponents)                            \
  X(shrink, rg::shrink, rg::gpu::shrink)                                                    \
  X(matchBlocks, rg::matchBlocks, rg::gpu::matchBlocks)                                     \
  X(sumBlocks, rg::sumBlocks, rg::gpu::sumBlocks)                                           \
  X(warpByCamera, rg::warpByCamera, rg::gpu::warpByCamera)                                  \
  X(smooth, rg::background::smooth, rg::gpu::background::smooth)                            \
  X(fillFrom, rg::background::fillFrom, rg::gpu::background::fillFrom)                      \
  X(judge, rg::background::judge, rg::gpu::background::judge)                               \
  X(learn, rg::background::learn, rg::gpu::background::learn)                               \
  X(replaceWhere, rg::background::replaceWhere, rg::gpu::background::replaceWhere)          \
  X(paintModel, rg::background::paintModel, rg::gpu::background::paintModel)                \
  X(paintModelAt, rg::background::paintModelAt, rg::gpu::background::paintModelAt)          \
  X(keepMajority, rg::background::keepMajority, rg::gpu::background::keepMajority)          \
  X(dropSmallParts, rg::background::dropSmallParts, rg::gpu::background::dropSmallParts)    \
  X(fillHoles, rg::background::fillHoles, rg::gpu::background::fillHoles)                   \
  X(keepSupported, rg::background::keepSupported, rg::gpu::background::keepSupported)       \
  X(dropSwaying, rg::background::dropSwaying, rg::gpu::background::dropSwaying)             \
  X(smoothAndJudge, rg::background::smoothAndJudge, rg::gpu::background::smoothAndJudge)    \
  X(growFaint, rg::background::growFaint, rg::gpu::background::growFaint)                   \
  X(trimBorder, rg::background::trimBorder, rg::gpu::background::trimBorder)                \
  X(followStill, rg::background::followStill, rg::gpu::background::followStill)             \
  X(addAged, rg::background::addAged, rg::gpu::background::addAged)                         \
  X(findGhosts, rg::background::findGhosts, rg::gpu::background::findGhosts)                \
  X(addDisplaced, rg::background::addDisplaced, rg::gpu::background::addDisplaced)          \
  X(countLit, rg::background::countLit, rg::gpu::background::countLit)                      \
  X(countVivid, rg::background::countVivid, rg::gpu::background::countVivid)                \
  X(sumShifted, rg::background::sumShifted, rg::gpu::background::sumShifted)                \
  X(countFullFields, rg::background::countFullFields, rg::gpu::background::countFullFields) \
  X(shiftPicture, rg::background::shiftPicture, rg::gpu::background::shiftPicture)          \
  X(countApart, rg::background::countApart, rg::gpu::background::countApart)                \
  X(relight, rg::background::relight, rg::gpu::background::relight)                         \
  X(sumGains, rg::background::sumGains, rg::gpu::background::sumGains)                      \
  X(mapLevels, rg::background::mapLevels, rg::gpu::background::mapLevels)                   \
  X(paintForeground, rg::background::paintForeground, rg::gpu::background::paintForeground) \
  X(train, rg::background::train, rg::gpu::background::train)                               \
  X(finishTraining, rg::background::finishTraining, rg::gpu::background::finishTraining)    \
  X(testGaussian, rg::background::testGaussian, rg::gpu::background::testGaussian)          \
  X(updateGaussian, rg::background::updateGaussian, rg::gpu::background::updateGaussian)    \
  X(paintMean, rg::background::paintMean, rg::gpu::background::paintMean)                   \
  X(differ, rg::background::differ, rg::gpu::background::differ)                            \
  X(measureChange, rg::background::measureChange, rg::gpu::background::measureChange)       \
  X(markChange, rg::background::markChange, rg::gpu::background::markChange)                \
  X(addStrange, rg::background::addStrange, rg::gpu::background::addStrange)                \
  X(keepDense, rg::background::keepDense, rg::gpu::background::keepDense)                   \
  X(findShadows, rg::background::findShadows, rg::gpu::background::findShadows)             \
  X(keepCastShadows, rg::background::keepCastShadows, rg::gpu::background::keepCastShadows) \
  X(classifyHues, rg::segmentation::classifyHues, rg::gpu::segmentation::classifyHues)      \
  X(smoothColours, rg::segmentation::ColourCells, rg::gpu::segmentation::smoothColours)     \
  X(averageCells, rg::segmentation::ColourCells, rg::gpu::segmentation::averageCells)       \
  X(linkColours, rg::segmentation::ColourLinks, rg::gpu::segmentation::linkColours)         \
  X(findFrameBand, rg::segmentation::findFrameBand, rg::gpu::segmentation::findFrameBand)   \
  X(coverAreas, rg::segmentation::coverAreas, rg::gpu::segmentation::coverAreas)            \
  X(scopeByHue, rg::segmentation::scopeByHue, rg::gpu::segmentation::scopeByHue)            \
  X(groupLinked, rg::segmentation::PixelRuns, rg::gpu::segmentation::groupLinked)           \
  X(groupLabelled, rg::segmentation::PixelRuns, rg::gpu::segmentation::groupLabelled)       \
  X(absorb, rg::segmentation::Absorption, rg::gpu::segmentation::absorb)                    \
  X(divideRegions, rg::segmentation::RegionDivision, rg::gpu::segmentation::divideRegions)  \
  X(divideAgain, rg::segmentation::RegionDivision, rg::gpu::segmentation::divideAgain)      \
  X(refineBorders, rg::segmentation::BorderPixels, rg::gpu::segmentation::refineBorders)    \
  X(buildGraph, rg::graph::makeStage, rg::gpu::graph::buildGraph)                           \
  X(padLuma, rg::motion::PaddedLuma, rg::gpu::motion::padLuma)                              \
  X(padSmooth, rg::motion::PaddedLuma, rg::gpu::motion::padSmooth)                          \
  X(sumMoments, rg::motion::sumMoments, rg::gpu::motion::sumMoments)                        \
  X(sumBoxes, rg::motion::BoxSums, rg::gpu::motion::sumBoxes)                               \
  X(searchShifts, rg::motion::searchShifts, rg::gpu::motion::searchShifts)                  \
  X(findStill, rg::motion::isUnchanged, rg::gpu::motion::findStill)                         \
  X(sumGradients, rg::motion::sumGradients, rg::gpu::motion::sumGradients)                  \
  X(estimateMotion, rg::motion::estimateMotion, rg::gpu::motion::estimateMotion)            \
  X(compareRegions, rg::objects::compareRegions, rg::gpu::objects::compareRegions)          \
  X(carryEvidence, rg::objects::carryEvidence, rg::gpu::objects::carryEvidence)             \
  X(addEvidence, rg::objects::addEvidence, rg::gpu::objects::addEvidence)                   \
  X(findObjectPixels, rg::objects::findObjectPixels, rg::gpu::objects::findObjectPixels)    \
  X(sumIntegrals, rg::detection::sumIntegrals, rg::gpu::detection::sumIntegrals)            \
  X(locateWindows, rg::detection::placeOf, rg::gpu::detection::locateWindows)               \
  X(judgeWindows, rg::detection::judgeWindows, rg::gpu::detection::judgeWindows)
