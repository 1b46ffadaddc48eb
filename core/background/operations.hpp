// SPDX-License-Identifier: LGPL-2.1-or-later
// What the default method does with pixels, step by step: by the functions of this room, or by a
// device's counterparts of them. Which of the two did a step can't be seen in its result.
#pragma once

#include "core/background/background.hpp"
#include "core/background/ghosts/displaced_things.hpp"
#include "core/background/ghosts/ghosts.hpp"
#include "core/background/ghosts/mask_contour.hpp"
#include "core/background/ghosts/swaying_parts.hpp"
#include "core/background/light/exposure.hpp"
#include "core/background/light/light_switch.hpp"
#include "core/background/mask_cleaning.hpp"
#include "core/background/models/consensus_background.hpp"
#include "core/background/scene_watch.hpp"
#include "core/background/shadows/cast_shadows.hpp"
#include "core/base/bit_mask.hpp"
#include "core/base/components.hpp"
#include "core/base/histogram.hpp"
#include "core/base/mask_gaps.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace rg::background {

/// The planes of a model that is shown as a picture.
using ShownModel = std::array<Image<uint8_t>, 3>;

/// Each does what the function of its name does; this class does it on the CPU.
class Operations {
 public:
  explicit Operations(const Executor& executor) : executor_(executor) {}
  virtual ~Operations() = default;
  Operations(const Operations&) = delete;
  Operations& operator=(const Operations&) = delete;

  // The model.
  virtual void smooth(const Picture& picture, SmoothPicture& out);
  virtual void smoothAndJudge(const Picture& picture, const ConsensusBackground& model,
                              const Tolerance& tolerance, const JudgedPicture& out);
  virtual void judge(const SmoothPicture& picture, const ConsensusBackground& model,
                     const Tolerance& tolerance, Verdicts& out);
  virtual void fillFrom(const SmoothPicture& picture, ConsensusBackground& model);
  virtual void learn(const SmoothPicture& picture, const LearntFrame& seen,
                     const ConsensusRate& rate, ConsensusBackground& model);
  virtual void replaceWhere(const BitMask& places, const SmoothPicture& picture,
                            ConsensusBackground& model);
  virtual void paintModel(const ConsensusBackground& model, ShownModel& out);
  virtual void paintModelAt(const BitMask& places, const ConsensusBackground& model,
                            ShownModel& out);

  // The scene.
  virtual uint32_t countSet(const BitMask& mask);
  virtual bool isDarkerThan(const SmoothPicture& picture, int level);
  virtual bool isEverywhere(const BitMask& mask);
  virtual bool hasSwitchedColour(const SmoothPicture& picture, const ConsensusBackground& model);
  virtual Shift findShift(const SmoothPicture& picture, const ConsensusBackground& model,
                          Point centre);
  virtual void shiftPicture(Point shift, SmoothPicture& spare, SmoothPicture& picture);
  virtual Histogram countLevels(const Image<uint8_t>& plane);
  virtual LevelMaps matchLight(const ShownModel& shown, const SmoothPicture& picture);
  virtual uint32_t countApart(const ShownModel& shown, const SmoothPicture& picture,
                              const LevelMaps& maps, const ConsensusBackground& model,
                              const Tolerance& tolerance);
  virtual void relight(const LevelMaps& maps, ConsensusBackground& model);
  virtual int findGain(const SmoothPicture& picture, const ConsensusBackground& model);
  virtual void mapLevels(const LevelMap& map, SmoothPicture& picture);

  // Masks.
  virtual void keepMajority(const BitMask& mask, int radius, int share, BitMask& out);
  virtual void keepSupported(BitMask& mask, const BitMask& strong, uint32_t leastPx);
  virtual void dropSwaying(const SmoothPicture& picture, const ConsensusBackground& model,
                           const Tolerance& tolerance, BitMask& mask);
  virtual void fillHoles(BitMask& mask, uint32_t mostPx);
  virtual void dropSmallParts(BitMask& mask, uint32_t leastPx);
  virtual void fillUnedged(const SmoothPicture& picture, int mostStep, uint32_t mostPx,
                           BitMask& mask);
  virtual void growFaint(const FaintEvidence& evidence, BitMask& mask);
  virtual void trimBorder(const BorderEvidence& evidence, BorderLayer layer, BitMask& mask);
  virtual void thicken(const BitMask& mask, int margin, BitMask& out);
  virtual void remove(const BitMask& b, BitMask& a);
  virtual void keepOnly(const BitMask& b, BitMask& a);

  // What stands still.
  virtual void followStill(const SmoothPicture& picture, const ConsensusBackground& model,
                           const Tolerance& tolerance, const BitMask& foreground, uint16_t mostAge,
                           StillPixels& still);
  virtual void findGhosts(const SmoothPicture& picture, const ConsensusBackground& model,
                          const BitMask& foreground, StillPixels& still, int leastAge,
                          BitMask& ghosts);
  virtual void addAged(const BitMask& foreground, const StillPixels& still, int64_t leastAge,
                       BitMask& ghosts);
  virtual void addDisplaced(const SmoothPicture& picture, const ConsensusBackground& model,
                            const BitMask& foreground, const StillPixels& still, int64_t leastAge,
                            BitMask& moved);

  // What is left.
  virtual void findShadows(const SmoothPicture& picture, const ShownModel& shown,
                           const BitMask& mask, BitMask& shadow);
  virtual void keepCastShadows(const BitMask& mask, BitMask& dark);
  virtual void paintForeground(const BitMask& mask, const BitMask& shadow, Point shift,
                               Image<uint8_t>& out);

 protected:
  [[nodiscard]] const Executor& executor() const { return executor_; }

 private:
  const Executor& executor_;
  BitMask across_;
  CleaningScratch cleaning_;
  GapScratch gaps_;
  ContourScratch contour_;
  SwayScratch sway_;
  StillScratch still_;
  DisplacedScratch moved_;
  CastShadowScratch castShadows_;
};

}  // namespace rg::background
