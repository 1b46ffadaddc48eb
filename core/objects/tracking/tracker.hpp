// SPDX-License-Identifier: LGPL-2.1-or-later
// Objects over time: each keeps its number while it moves, stops, is hidden, or shares a blob.
//
// Every frame, tracks are predicted, boxes of their size are fitted to the foreground together
// (core/objects/tracking/box_fit.hpp), what is left over becomes newcomers, and newcomers that look
// like a track that is missing are that track.
//
// Determinism: integers. Tracks are sorted by id; every choice has a key that ends in an id or a
// raster position.
#pragma once

#include "core/objects/objects.hpp"
#include "core/objects/tracking/assignment.hpp"
#include "core/objects/tracking/box_fit.hpp"
#include "core/objects/tracking/clutter.hpp"
#include "core/objects/tracking/group_grid.hpp"
#include "core/objects/tracking/looks/appearance.hpp"
#include "core/objects/tracking/looks/portrait.hpp"
#include "core/objects/tracking/pieces.hpp"
#include "core/objects/tracking/scene_scale.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace rg::objects {

/// What positions and lengths are kept within, so that a few can be added.
constexpr int32_t toInt(int64_t value) {
  return static_cast<int32_t>(std::clamp<int64_t>(value, INT32_MIN / 4, INT32_MAX / 4));
}

/// An edge of a track's box that stays where it is, and where the opposite one was at first, in px.
struct StandingEdge {
  int place = -1000, opposite = -1000;
};

/// One object's history. Positions in 1/16 px, of the middle of the box's lower edge (the foot).
struct Track {
  uint64_t id = 0;
  ObjectState state = ObjectState::New;
  int32_t x = 0, foot = 0;
  int32_t speedX = 0, speedY = 0;  ///< Over the ground, in 1/16 px per second.
  Extent size;
  Look look;
  Look recent;  ///< Since it came out of a blob of several, while it is in doubt.
  Portrait portrait;
  graph::Colour colour;
  std::vector<uint64_t> parents;
  int64_t unseenNs = 0;  ///< Since it was last seen.
  int64_t ageNs = 0;
  int64_t seenNs = 0;                 ///< Of its age.
  int64_t stillNs = 0;                ///< Since it last left its place.
  int32_t stillX = 0, stillFoot = 0;  ///< That place.
  Extent stillSize;                   ///< Its size there.
  uint32_t ageFrames = 0;
  uint32_t hits = 0;                    ///< Frames in which it was seen.
  uint32_t sizeSamples = 0;             ///< Frames in which all of it was seen.
  int32_t originX = 0, originFoot = 0;  ///< Where it was first seen.
  int32_t learntX = 0, learntFoot = 0;  ///< Where the scene's scale last learnt from it.
  int32_t centreX = 0, centreY = 0;     ///< From its box's middle to the mean of its pixels.
  uint32_t centreSamples = 0;           ///< Frames from which that was learnt.
  int32_t steadyX = 0, steadyY = 0;     ///< Its speed over the last half second or so.
  bool isWhole = false;                 ///< All of it is seen in this frame.
  StandingEdge leftEdge, rightEdge;
  uint16_t sway = 64;    ///< By how much its box changes, in 1/256 of its size.
  uint16_t fill = 150;   ///< Share of its box that is foreground, in 1/256.
  bool isSeen = false;   ///< In this frame.
  uint64_t company = 0;  ///< Smallest id of those that it shares a blob with.
  uint64_t nextCompany = 0;
  int64_t companyNs = 0;           ///< Since nextCompany holds.
  int64_t apartNs = 0;             ///< For how long it was seen in a blob of its own.
  int64_t partedNs = 0;            ///< Since it consists of several blobs.
  int64_t doubleNs = 0;            ///< Since it looks like a part of another track.
  int32_t partOffset = INT32_MIN;  ///< Between the middles of its blob and of another part above or
                                   ///< below, when they were first seen, in half pixels.
  bool isStanding = false;         ///< Its regions show that it doesn't move in this frame.
  bool isOver = false;
  bool hasMoved = false;
  bool isFromBorder = false;  ///< First seen where things come into the picture, or moving.
  bool isConfirmed = false;
  bool hasTravelled = false;  ///< It was half its width away from where it was first seen.
  bool isInDoubt = false;     ///< It may have taken another's place.

  [[nodiscard]] Box box() const;  ///< In pixels.
  /// Where the portrait lies, in pixels, once the picture has moved by `camera` (1/16 px).
  [[nodiscard]] Point portraitCorner(Point camera = {}) const;
};

struct TrackerParams {
  int64_t maxLostNs = 2'000'000'000;
  uint32_t minAreaPx = 0;  ///< 0 = learnt from the scene.
  Numbers numbers{};
};

/// What the fit says of a track in this frame.
struct Sighting {
  int task = -1;               ///< −1: it was not looked for.
  uint32_t cells = 0;          ///< That it owns.
  uint32_t boxCells = 0;       ///< Of its fitted box within the frame.
  uint32_t othersCells = 0;    ///< Of its fitted box that other tracks own.
  bool isParted = false;       ///< Other blobs beside its own seem to be parts of it.
  bool isCutOff = false;       ///< `box` lacks an end of what is expected there.
  bool isStanding = false;     ///< Its regions show that it doesn't move.
  bool isSole = false;         ///< Nobody else is in its blob.
  bool isWhole = false;        ///< `box` shows all of it.
  bool isMatched = false;      ///< Its portrait was found.
  uint32_t share = 0;          ///< Of the portrait that was found, in 1/256.
  Box box;                     ///< Pixels, around the groups that it owns.
  uint64_t areaPx = 0;         ///< Of those groups.
  int64_t sumX = 0, sumY = 0;  ///< Of the places of their pixels, in 1/256 px.
  LookCounts look;
  Point matched;  ///< Middle of the lower edge of the portrait, in 1/16 px.
};

/// Middle of a box's lower edge, in 1/16 px.
struct Place {
  int64_t x = 0, foot = 0;
};

/// Where a track is of which `part` is seen, in pixels: as near to its expected place as the part's
/// edges inside the frame allow.
[[nodiscard]] Place placeOfPart(const Track& track, const Box& part, Size frame);

/// A track that is looked for by its portrait.
struct PortraitTask {
  size_t track = 0, fit = 0;  ///< Indices.
  PortraitSearch search;
  PortraitMatch match;
  Point corner;  ///< Where it was found, in pixels.
};

/// Foreground that no track explains and that is large enough to be something.
struct Newcomer {
  Box box;  ///< In pixels.
  uint32_t cells = 0;
  uint16_t group = 0;   ///< Of its largest piece.
  uint64_t parent = 0;  ///< Id of the track whose blob it comes out of, 0 = none.
  bool isAtBorder = false;
  LookCounts look;
  Look appearance;
};

/// Two tracks that were in one blob and have not been judged since.
struct Encounter {
  uint64_t first = 0, second = 0;  ///< Ids, the smaller one first.
  bool isTogether = false;         ///< In this frame.
};

/// Who has more than half of what is counted (Boyer and Moore), found without a table of all pairs.
/// Both passes must count the same things; their order doesn't change who has a majority.
struct Majority {
  uint32_t value = 0;
  uint32_t lead = 0;
  uint32_t votes = 0;  ///< For `value`, after the second pass.
  uint32_t total = 0;

  void propose(uint32_t candidate, uint32_t times) {
    if (lead == 0) value = candidate;
    if (candidate == value) {
      lead += times;
    } else if (times <= lead) {
      lead -= times;
    } else {
      value = candidate;
      lead = times - lead;
    }
  }
  void count(uint32_t candidate, uint32_t times) {
    votes += candidate == value ? times : 0;
    total += times;
  }
};

/// What a tracker's successor must know: which objects readers take to be there, and the next id.
struct TrackerLegacy {
  std::vector<uint64_t> alive;  ///< Sorted.
  uint64_t nextId = 1;
};

class Tracker {
 public:
  /// Ends all tracks; the next update's events tell. The scene's scale stays.
  void reset();
  /// As of the last takeEvents(), whatever has become of the tracker since.
  [[nodiscard]] TrackerLegacy bequeath() noexcept;
  /// Goes on after another tracker, whose objects end with the next update's events.
  void inherit(TrackerLegacy&& legacy) noexcept;
  /// A frame that shows nothing: tracks move on as they are expected to.
  void predict(int64_t stepNs, const TrackerParams& params);
  void update(const GroupGrid& evidence, std::span<const Group> groups, int64_t stepNs,
              const TrackerParams& params);

  [[nodiscard]] const std::vector<Track>& tracks() const { return tracks_; }
  /// Of each cell of the evidence: 1 + index of the track, 0 = none.
  [[nodiscard]] const std::vector<uint16_t>& owner() const { return owner_; }
  /// The events of the last update, which are told once; ends what they began and ended. Adds
  /// `isAnotherScene` as an event.
  void takeEvents(bool isAnotherScene, std::vector<Event>& out);
  /// How far a track will move in the next `stepNs`, in pixels, while the camera moves so.
  [[nodiscard]] static Point expectedShift(const Track& track, const CameraMotion& camera,
                                           int64_t stepNs);
  /// Whether its portrait tells where it is.
  [[nodiscard]] bool isFaithful(const Track& track) const;
  void remember(size_t index, graph::Colour colour) { tracks_[index].colour = colour; }
  [[nodiscard]] const SceneScale& scale() const { return scale_; }
  /// Of the last frame.
  [[nodiscard]] const Numbers& numbers() const { return numbers_; }

 private:
  [[nodiscard]] static Point stepOf(const Track& track, int64_t stepNs);
  static void moveWithCamera(Track& track, const CameraMotion& camera);
  void advance(Track& track, int64_t stepNs) const;
  [[nodiscard]] FitTask fitTaskOf(size_t index, const GroupGrid& evidence, int64_t stepNs) const;
  void lookForTracks(const GroupGrid& evidence, int64_t stepNs);
  void giveStrides(const GroupGrid& evidence);
  void giveGroups(const GroupGrid& evidence, std::span<const Group> groups);
  void findBlobs(const GroupGrid& evidence);
  void findOwnBlobs(const GroupGrid& evidence);
  [[nodiscard]] bool isComplete(size_t index, const GroupGrid& evidence) const;
  [[nodiscard]] bool isAbout(const Box& box, const Track& track) const;
  [[nodiscard]] bool isClear(size_t index, const GroupGrid& evidence) const;
  void listPortraits(const GroupGrid& evidence);
  void placeByPortraits(const GroupGrid& evidence, int64_t stepNs);
  [[nodiscard]] PortraitSearch searchOf(size_t index, int64_t stepNs) const;
  [[nodiscard]] PortraitMatch findTrack(const PortraitScene& scene, const PortraitTask& task);
  [[nodiscard]] bool isDisturbed(size_t index, const GroupGrid& evidence) const;
  void giveMatch(const PortraitScene& scene, PortraitTask& task);
  void learnPortrait(size_t index, const GroupGrid& evidence);
  void giveBlobs(const GroupGrid& evidence);
  template <class Visit>
  void forStrayCells(const GroupGrid& evidence, const Visit& visit) const;
  void partTracks(const GroupGrid& evidence);
  void limitTracks(const GroupGrid& evidence);
  void reclaimExpected(const GroupGrid& evidence);
  void spreadOwners(const GroupGrid& evidence);
  void countCells(const GroupGrid& evidence);
  void dropStrangers(const GroupGrid& evidence);
  [[nodiscard]] bool hasTheRest(size_t index) const;
  [[nodiscard]] bool goesBehind(Track& track, const Box& box) const;
  void sight(const GroupGrid& evidence);
  [[nodiscard]] bool isSizeKnown(const Track& track) const;
  [[nodiscard]] bool isRigid(const Track& track) const;
  void findNewcomers(const GroupGrid& evidence, const TrackerParams& params);
  void describeNewcomers(const GroupGrid& evidence);
  void giveFragments(const GroupGrid& evidence);
  void giveNewcomers(const GroupGrid& evidence);
  [[nodiscard]] bool comesApart(const GroupGrid& evidence, const Newcomer& newcomer) const;
  void dropSmall(const GroupGrid& evidence, const TrackerParams& params);
  void rejoin(const GroupGrid& evidence);
  [[nodiscard]] int64_t rejoinCost(const GroupGrid& evidence, const Track& track,
                                   const Newcomer& newcomer);
  [[nodiscard]] std::optional<Point> recognise(const GroupGrid& evidence, const Track& track,
                                               const Newcomer& newcomer);
  [[nodiscard]] int likeness(const Track& track, const Newcomer& newcomer) const;
  void comeBack(const GroupGrid& evidence, Track& track, const Newcomer& newcomer);
  void meet();
  [[nodiscard]] Track* find(uint64_t id);
  void learnLook(size_t index);
  void judgeIdentities();
  void exchange(Track& a, Track& b);
  void correct(size_t index, int64_t stepNs);
  [[nodiscard]] Place placeOf(size_t index);
  [[nodiscard]] bool hidesAnother(const Track& track) const;
  [[nodiscard]] Place placeOfWhole(Track& track, const Sighting& sighting) const;
  void miss(Track& track, int64_t stepNs) const;
  void mixSize(Track& track, const Sighting& sighting) const;
  void learnSize(size_t index, int64_t stepNs, const GroupGrid& evidence);
  [[nodiscard]] uint64_t parentOf(const Newcomer& newcomer) const;
  void begin(const Newcomer& newcomer);
  [[nodiscard]] bool isCovered(const Track& track) const;
  void fitSizeToScene(Track& track) const;
  void learnScale(const GroupGrid& evidence);
  [[nodiscard]] bool outgrows(const Track& track, const Box& box) const;
  [[nodiscard]] bool areOneBody(const GroupGrid& evidence, size_t a, size_t b) const;
  void joinDoubles(const GroupGrid& evidence, int64_t stepNs);
  void findCompany(int64_t stepNs);
  void tellCompany();
  void tellNew(const Track& track);
  [[nodiscard]] int64_t movedBy(const Track& track) const;
  [[nodiscard]] Extent sizeOfPart(const Track& track, const Box& box) const;
  [[nodiscard]] bool isLeaving(const Track& track) const;
  void settleState(Track& track, int64_t stepNs) const;
  void settle(int64_t stepNs, const TrackerParams& params);

  Numbers numbers_;  ///< Of the frame.
  std::vector<Track> tracks_;
  std::vector<Event> events_;
  TrackerLegacy told_;    ///< As of the last takeEvents().
  bool endsAll_ = false;  ///< By a reset: the end of all that were told is to be told.
  SceneScale scale_;
  Clutter clutter_;
  uint64_t nextId_ = 1;
  Size frame_;
  int stepPx_ = 1;
  bool showsMovers_ = false;

  std::vector<Sighting> sightings_;  ///< Of tracks_.
  std::vector<FitTask> tasks_;
  std::vector<size_t> order_;  ///< Scratch.
  std::vector<uint16_t> owner_;
  FitScratch fitScratch_;
  std::vector<Piece> pieces_;
  PieceScratch pieceScratch_;
  std::vector<Newcomer> newcomers_;
  std::vector<int> newcomerOf_;  ///< Of each piece, −1 = none.
  std::vector<Majority> majorities_;
  std::vector<Piece> blobs_;  ///< Connected parts of all the foreground.
  PieceScratch blobScratch_;
  std::vector<uint32_t> blobCells_, seenBlobs_;
  std::vector<uint32_t> blobOf_;     ///< Of each track: 1 + blob, 0 = none.
  std::vector<uint16_t> distance_;   ///< Of each cell from those that owned it first.
  std::vector<Box> limits_;          ///< Of each track, cells: beyond, nothing is part of it.
  std::vector<uint16_t> soleTrack_;  ///< Of each blob (from 1): 1 + the only track in it, or 0.
  std::vector<int> trackOfNewcomer_;
  std::vector<PortraitTask> portraitTasks_;
  std::vector<uint8_t> taken_;  ///< Of each cell.
  std::vector<uint8_t> isSearched_;
  PortraitScratch portraitScratch_;
  std::vector<Encounter> encounters_;  ///< Sorted by ids.
  std::vector<uint32_t> touching_;
  std::vector<uint16_t> trackIndex_;
  std::vector<uint64_t> companyBefore_;
  std::vector<int64_t> costs_;
  Assignment assignment_;
};

}  // namespace rg::objects
