// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/objects.hpp"

#include "core/base/memory/operations_source.hpp"
#include "core/base/memory/pool.hpp"
#include "core/base/renewed_stage.hpp"
#include "core/base/time/time.hpp"
#include "core/objects/merge/ground_merge.hpp"
#include "core/objects/merge/motion_trends.hpp"
#include "core/objects/merge/mrf_merge.hpp"
#include "core/objects/movers.hpp"
#include "core/objects/operations.hpp"
#include "core/objects/tracking/looks/contour.hpp"
#include "core/objects/tracking/region_owners.hpp"
#include "core/objects/tracking/standing_tracks.hpp"
#include "core/objects/tracking/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace rg::objects {
namespace {

constexpr int64_t kLongestStepNs = 10'000'000'000;  // Sums of these last for 900 million frames.

class ObjectStage final : public Stage {
 public:
  explicit ObjectStage(Context context)
      : context_(std::move(context)), operations_(makeOperations<Operations>(context_)) {}

  Result<std::shared_ptr<const Objects>> process(Input in, const Params& params,
                                                 FrameTime time) override;
  void reset(Reset what) override;
  [[nodiscard]] TrackerLegacy bequeath() noexcept { return tracker_.bequeath(); }
  void inherit(TrackerLegacy&& legacy) noexcept { tracker_.inherit(std::move(legacy)); }

 private:
  MergeInput mergeRegions(const Input& in, const Params& params, int64_t stepNs, Objects& objects);
  MergeInput mergeByEnergy(const motion::Motion& motion, const MergeWeights& weights,
                           int64_t stepNs, Objects& objects);
  void nameGroups(const motion::Motion& shown, Objects& objects);
  void expectLabels(const motion::Motion& motion, bool isByVectors, int64_t stepNs,
                    Objects& objects);
  void startGroups();
  void recallStanding(const graph::Graph& graph, Objects& objects);
  void tieToGround(const graph::Graph& graph, const MergeWeights& weights,
                   std::vector<GroundEnergy>& energies);
  void markSurroundings(const Input& in, const Objects& objects);
  void markBackground(const Input& in, const Objects& objects);
  void gatherEvidence(const graph::Graph& graph, const Numbers::Layers& numbers,
                      const Objects& objects);
  void givePixels(const graph::Graph& graph, Objects& objects);
  void describe(const graph::Graph& graph, bool hasTime, Objects& objects);
  void nameRegions(const graph::Graph& graph, Objects& objects);
  int64_t stepTo(FrameTime time);
  [[nodiscard]] const Track& trackAt(TrackIndex index) const {
    return tracker_.tracks()[index.index()];
  }

  Context context_;
  std::unique_ptr<Operations> operations_;
  Tracker tracker_;
  MergeScratch mergeScratch_;
  std::vector<WeightedArc> arcs_;
  std::vector<uint32_t> groupOf_;        ///< Of each region, as the merging goes on.
  std::vector<TrackIndex> expected_;     ///< Of each region the track it is predicted to be.
  std::vector<TrackIndex> regionOwner_;  ///< Of each region the track that it is.
  std::vector<Point> shifts_;            ///< Of each track, pixels.
  RegionOwnerScratch ownerScratch_;
  std::vector<Group> groups_;
  std::vector<uint8_t> isBackground_;
  std::vector<int32_t> majority_;  ///< Of each group: foreground samples less the others.
  Movers movers_;                  ///< Under Scope::Frame.
  StandingScratch standingScratch_;
  std::vector<StandingTrack> standing_;  ///< Of each region, under Scope::Frame.
  std::vector<uint8_t> isOpen_;          ///< Of each region: it may be something else than ground.
  GroundScratch groundScratch_;
  GroupGrid evidence_;
  std::vector<uint8_t> isBackgroundRegion_;
  std::vector<ObjectSums> sums_;
  MotionTrends trends_;
  motion::Motion trend_;  ///< What they say of this frame's regions; where the camera stands.
  Pool<Objects> pool_;
  FrameTime last_;
  bool hasLast_ = false;
};

/// Time since the previous frame; a nominal step where it is unknown or runs backwards.
int64_t ObjectStage::stepTo(FrameTime time) {
  const bool isKnown = hasLast_ && time.isKnown && last_.isKnown && time.ns > last_.ns;
  const int64_t step = isKnown    ? std::min(timeBetween(last_.ns, time.ns), kLongestStepNs)
                       : hasLast_ ? kNominalStepNs
                                  : 0;
  last_ = time;
  hasLast_ = true;
  return step;
}

void ObjectStage::reset(Reset what) {
  if (what == Reset::Gap) return;  // The next frame's time tells how far to predict.
  tracker_.reset();
  movers_.reset();
  trends_.reset();
  hasLast_ = false;
}

/// The objects of the previous frame, moved as they are expected to, name the regions of this one.
void ObjectStage::expectLabels(const motion::Motion& motion, bool isByVectors, int64_t stepNs,
                               Objects& objects) {
  const graph::Graph& graph = *motion.graph;
  expected_.assign(graph.regions.size(), {});
  objects.regionExpected.assign(graph.regions.size(), 0);
  if (tracker_.owner().empty() || evidence_.frame != graph.size) return;
  if (isByVectors && motion.status != Status::Skipped)
    tracker_.measure(motion, objects.camera, stepNs, evidence_);
  shifts_.clear();
  for (const Track& track : tracker_.tracks())
    shifts_.push_back(expectedShift(track, objects.camera, stepNs));
  findRegionOwners(*graph.labels, evidence_, tracker_.owner(), shifts_, ownerScratch_, expected_);
  for (size_t r = 0; r < expected_.size(); ++r)
    if (expected_[r]) objects.regionExpected[r] = trackAt(expected_[r]).id;
}

/// Regions that are expected to be one object start as one group, all others alone.
void ObjectStage::startGroups() {
  const auto tracks = static_cast<uint32_t>(tracker_.tracks().size());
  groupOf_.resize(expected_.size());
  for (uint32_t r = 0; r < groupOf_.size(); ++r)
    groupOf_[r] = expected_[r] ? expected_[r].index() : tracks + r;
}

MergeInput ObjectStage::mergeRegions(const Input& in, const Params& params, int64_t stepNs,
                                     Objects& objects) {
  const motion::Motion& motion = *in.motion;
  const graph::Graph& graph = *motion.graph;
  const MergeWeights weights = weightsOf(params, graph.size, stepNs);
  const bool isStill = graph.labels->scope != segmentation::Scope::Frame;
  if (!isStill && motion.status != Status::Skipped) objects.setCamera(motion.camera);
  const bool tellsMovers = !isStill && params.method != Method::Literal;
  if (!tellsMovers) movers_.reset();
  expectLabels(motion, tellsMovers, stepNs, objects);
  if (params.method == Method::Literal) return mergeByEnergy(motion, weights, stepNs, objects);
  if (isStill) {
    followTrends(motion, *context_.cpu, trends_, trend_, params.numbers.layers);
  } else {
    trends_.reset();
    trend_.graph.reset();
    recallStanding(graph, objects);
  }
  const motion::Motion& shown = isStill ? trend_ : motion;
  weighArcs(shown, expected_, weights, objects.arcs);
  startGroups();
  if (!isStill) {
    const MoverRules rules{objects.arcs,           weights, expected_,
                           tracker_.tracks(),      stepNs,  nsPerPixel(params, graph.size),
                           params.numbers.parallax};
    movers_.find(motion, rules, *operations_);
    tieToGround(graph, weights, objects.ground);
    movers_.remember(motion, rules, *operations_);
    objects.groundGroup =
        minimiseWithGround(graph, objects.arcs, {objects.ground, isOpen_, movers_.moves()},
                           groundScratch_, mergeScratch_, groupOf_);
  } else {
    listArcs(graph, objects.arcs, arcs_);
    minimise(static_cast<uint32_t>(graph.regions.size()), arcs_, mergeScratch_, groupOf_);
  }
  nameGroups(shown, objects);
  markBackground(in, objects);
  return {shown, weights, stepNs};
}

/// Method::Literal.
MergeInput ObjectStage::mergeByEnergy(const motion::Motion& motion, const MergeWeights& weights,
                                      int64_t stepNs, Objects& objects) {
  trends_.reset();
  weighArcs(motion, expected_, weights, objects.arcs);
  startGroups();
  listArcs(*motion.graph, objects.arcs, arcs_);
  minimise(static_cast<uint32_t>(groupOf_.size()), arcs_, mergeScratch_, groupOf_);
  nameGroups(motion, objects);
  isBackground_.assign(groups_.size(), 0);
  objects.groundGroup = largestGroup(groups_, motion.size);
  objects.setCamera({});
  if (objects.groundGroup) {
    isBackground_[objects.groundGroup.index()] = 1;
    const Group& ground = groups_[objects.groundGroup.index()];
    objects.setCamera(CameraMotion(Point{ground.dx, ground.dy}));
  }
  return {motion, weights, stepNs};
}

void ObjectStage::nameGroups(const motion::Motion& shown, Objects& objects) {
  objects.isCutShort = mergeScratch_.isCutShort;
  objects.regionGroup.resize(groupOf_.size());
  std::transform(groupOf_.begin(), groupOf_.end(), objects.regionGroup.begin(),
                 GroupIndex::ofIndex);
  describeGroups(shown, objects.regionGroup, groups_);
}

void ObjectStage::tieToGround(const graph::Graph& graph, const MergeWeights& weights,
                              std::vector<GroundEnergy>& energies) {
  energies.clear();
  isOpen_.clear();
  const std::span<const OwnMotion> own = movers_.own();
  for (size_t r = 0; r < own.size(); ++r) {
    const bool isStopped{standing_[r].track};
    const int64_t before = movers_.gainBefore(r);
    // That it moves as the ground does says nothing against what has stopped.
    const int64_t gain = before + (isStopped ? std::max<int64_t>(0, own[r].gain) : own[r].gain);
    energies.push_back(weighGround(gain, graph.regions[r].areaPx, bool{expected_[r]}, weights,
                                   standing_[r].areaPx));
    const bool hasMoved = before > 0 && energies.back().weight() < 0;
    isOpen_.push_back(own[r].isTried() || isStopped || hasMoved);
    movers_.moves()[r] |= isStopped || hasMoved;
  }
}

/// What has stopped is expected where it is seen, whatever it did before.
void ObjectStage::recallStanding(const graph::Graph& graph, Objects& objects) {
  standing_.assign(graph.regions.size(), {});
  findStandingTracks(tracker_.state(), *graph.labels, objects.camera, graph.regions,
                     standingScratch_, standing_);
  for (size_t r = 0; r < standing_.size(); ++r) {
    if (!standing_[r].track) continue;
    expected_[r] = standing_[r].track;
    objects.regionExpected[r] = trackAt(standing_[r].track).id;
  }
}

/// Under Scope::Areas regions of the background lie round the things: a group of which most pixels
/// are not foreground. A sixteenth of the pixels tells it.
void ObjectStage::markSurroundings(const Input& in, const Objects& objects) {
  constexpr int kStep = 4;
  const graph::Graph& graph = *in.motion->graph;
  if (!in.foreground || in.foreground->mask.size() != graph.size) return;
  majority_.assign(groups_.size(), 0);
  for (int y = 0; y < graph.size.height; y += kStep) {
    const uint16_t* ids = graph.labels->ids.row(y);
    const uint8_t* mask = in.foreground->mask.row(y);
    for (int x = 0; x < graph.size.width; x += kStep)
      if (const auto label = segmentation::RegionLabel::ofNumber(ids[x]))
        majority_[objects.regionGroup[label.index()].index()] +=
            mask[x] == background::kForegroundPixel ? 1 : -1;
  }
  for (size_t g = 0; g < groups_.size(); ++g) isBackground_[g] = majority_[g] < 0;
}

/// Under Scope::Frame the ground's group is the background.
void ObjectStage::markBackground(const Input& in, const Objects& objects) {
  isBackground_.assign(groups_.size(), 0);
  if (in.motion->graph->labels->scope == segmentation::Scope::Areas)
    return markSurroundings(in, objects);
  if (objects.groundGroup) isBackground_[objects.groundGroup.index()] = 1;
}

void ObjectStage::givePixels(const graph::Graph& graph, Objects& objects) {
  isBackgroundRegion_.resize(graph.regions.size());
  for (size_t r = 0; r < isBackgroundRegion_.size(); ++r)
    isBackgroundRegion_[r] = isBackground_[objects.regionGroup[r].index()];
  sums_.resize(tracker_.tracks().size());
  operations_->findObjectPixels(graph, isBackgroundRegion_, {evidence_, tracker_.owner()},
                                {objects.slots, sums_});
}

void ObjectStage::describe(const graph::Graph& graph, bool hasTime, Objects& objects) {
  const std::vector<Track>& tracks = tracker_.tracks();
  objects.objects.resize(tracks.size());
  for (size_t i = 0; i < tracks.size(); ++i) {
    const Track& track = tracks[i];
    Object& object = objects.objects[i];
    const ObjectSums& sum = sums_[i];
    object.id = track.id;
    object.state = track.state;
    object.box = track.box();
    object.areaPx = static_cast<uint32_t>(sum.count);
    object.centroidX = track.x + track.centreX;
    object.centroidY = track.foot - track.size.height / 2 + track.centreY;
    object.colour = track.colour;
    if (sum.count > 0) {
      const auto mean = [&](uint64_t total) {
        return static_cast<uint8_t>((total + sum.count / 2) / sum.count);
      };
      // Of a part that is seen the mean would be that part's.
      if (track.isWhole || track.centreSamples == 0) {
        object.centroidX =
            static_cast<int32_t>((sum.x * kPositionUnit + sum.count / 2) / sum.count);
        object.centroidY =
            static_cast<int32_t>((sum.y * kPositionUnit + sum.count / 2) / sum.count);
      }
      object.colour = {mean(sum.red), mean(sum.green), mean(sum.blue)};
    }
    tracker_.remember(i, object.colour);
    object.hasSpeed = hasTime;
    object.speedX = hasTime ? track.speedX : 0;
    object.speedY = hasTime ? track.speedY : 0;
    object.ageFrames = track.ageFrames;
    object.parents = track.parents;
    object.contour.clear();
    if (sum.count > 0)
      traceContour(objects.slots, sum.first, 4 * (graph.size.width + graph.size.height),
                   object.contour);
  }
}

/// A region is of the object that owns most of its cells.
void ObjectStage::nameRegions(const graph::Graph& graph, Objects& objects) {
  shifts_.assign(tracker_.tracks().size(), {});
  regionOwner_.resize(graph.regions.size());
  findRegionOwners(*graph.labels, evidence_, tracker_.owner(), shifts_, ownerScratch_,
                   regionOwner_);
  objects.regionObject.assign(graph.regions.size(), 0);
  for (size_t r = 0; r < regionOwner_.size(); ++r)
    if (regionOwner_[r]) objects.regionObject[r] = trackAt(regionOwner_[r]).id;
}

void ObjectStage::gatherEvidence(const graph::Graph& graph, const Numbers::Layers& numbers,
                                 const Objects& objects) {
  gather(graph, objects.regionGroup, isBackground_, expected_, evidence_);
  evidence_.camera = objects.camera;
  evidence_.showsMovers = graph.labels->scope == segmentation::Scope::Frame;
  evidence_.isStill.clear();
  for (const Group& group : groups_)
    evidence_.isStill.push_back(
        !evidence_.showsMovers && group.reliability >= numbers.leastTrust.whole() &&
        std::abs(group.dx) + std::abs(group.dy) < numbers.stillDrift.whole());
}

Result<std::shared_ptr<const Objects>> ObjectStage::process(Input in, const Params& params,
                                                            FrameTime time) {
  const std::shared_ptr<const motion::Motion>& motion = in.motion;
  const std::shared_ptr<Objects> objects = pool_.take();
  objects->size = motion->size;
  objects->events.clear();
  objects->regionObject.clear();
  objects->regionExpected.clear();
  objects->regionGroup.clear();
  objects->arcs.clear();
  objects->groundGroup = {};
  objects->ground.clear();
  objects->isCutShort = false;
  objects->setCamera({});
  const TrackerParams tracking{
      static_cast<int64_t>(std::clamp(params.maxLostTimeS, 0.0, 3600.0) * 1e9),
      static_cast<uint32_t>(std::lround(std::clamp(params.minObjectArea, 0.0, 100.0) / 100 *
                                        static_cast<double>(motion->size.area()))),
      static_cast<int32_t>(std::lround(std::clamp(params.appearanceWeight, 0.0, 1000.0) * 256)),
      params.numbers};
  const int64_t stepNs = stepTo(time);
  const std::shared_ptr<const graph::Graph> graph = motion->graph;
  // prmmotion skips the first frame of all; its regions are there nevertheless.
  const bool hasRegions = graph && graph->labels && graph->status != Status::Skipped;
  objects->status = hasRegions ? graph->status : Status::Skipped;
  objects->motion = motion;
  if (!hasRegions) {
    tracker_.predict(stepNs, tracking);
    objects->objects.clear();
    objects->slots.resize(motion->size);
    objects->slots.fill(0);
    tracker_.takeEvents(false, objects->events);
    return std::shared_ptr<const Objects>(objects);
  }
  const MergeInput merged = mergeRegions(in, params, stepNs, *objects);
  gatherEvidence(*graph, params.numbers.layers, *objects);
  tracker_.update(evidence_, merged, tracking, *context_.cpu);
  givePixels(*graph, *objects);
  describe(*graph, time.isKnown, *objects);
  nameRegions(*graph, *objects);
  tracker_.takeEvents(in.foreground && background::isAnotherView(in.foreground->scene.event),
                      objects->events);
  return std::shared_ptr<const Objects>(objects);
}

}  // namespace

Input::Input(std::shared_ptr<const motion::Motion> found) : motion(std::move(found)) {
  if (motion && motion->graph && motion->graph->labels)
    foreground = motion->graph->labels->foreground;
}

std::unique_ptr<Stage> makeStage(Context context) {
  return std::make_unique<RenewedStage<Stage, ObjectStage>>(std::move(context));
}

}  // namespace rg::objects
