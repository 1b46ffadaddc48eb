// SPDX-License-Identifier: LGPL-2.1-or-later
// The numbers of this room that were chosen by measuring, each with its unit and reason. All of
// them can be moved at run time (Params::numbers): tests/accuracy/sensitivity.py tells what that
// does. Not here: units, bounds of work, what follows from something else, and what pixels on a
// device are compared by.
#pragma once

#include <compare>
#include <cstdint>

namespace rg::objects {

/// Something in units of 1/den, which integers can be compared with exactly.
struct Scaled {
  int64_t num = 0, den = 1;
};
constexpr std::strong_ordering operator<=>(int64_t a, Scaled b) {
  return a * b.den <=> b.num;
}
constexpr bool operator==(int64_t a, Scaled b) {
  return a * b.den == b.num;
}

/// num / den, den > 0.
struct Number {
  int64_t num = 0, den = 1;

  /// The number times x, towards 0.
  [[nodiscard]] constexpr int64_t of(int64_t x) const { return num * x / den; }
  /// The nearest integer.
  [[nodiscard]] constexpr int64_t whole() const { return (2 * num + den) / (2 * den); }
};
constexpr Scaled operator*(Number n, int64_t x) {
  return {n.num * x, n.den};
}
constexpr Scaled operator*(int64_t x, Number n) {
  return n * x;
}

constexpr Number ms(int64_t count) {
  return {count * 1'000'000};
}

/// All members are Number, so that it can be walked as an array of them.
struct Numbers {
  /// The energy of an arc (core/objects/merge/mrf_merge.hpp).
  struct Energy {
    Number halfContrast{16};  ///< Grey levels across a border that halve what parting costs there.
    Number halfColour{30};    ///< The same of two colours as a whole.
    Number arcLength{1, 16};  ///< An arc costs as much as a border of that share of a square as
                              ///< large as the frame.
    Number mostExcess{6};     ///< Squared thresholds; a thing inside another has a border of four
                              ///< to five times the root of its area, which this has to outweigh.
  } energy;

  /// What stands still before the plane of the camera's motion (core/objects/merge/parallax.hpp).
  struct Parallax {
    Number leastSlide{3, 4};    ///< Pixels beyond the plane: less may be the camera's error.
    Number offLine{1, 2};       ///< Pixels that a region's vector may be off across,
    Number offLineShare{1, 6};  ///< or the same as a share of its slide.
    Number leastShare{1, 200};  ///< Of what can be relied on, beside the heaviest piece.
    Number followed = ms(600);  ///< What has been seen for so long was there before.
  } parallax;

  /// How regions have moved so far.
  struct Layers {
    Number trendFrames{8};   ///< That a trend remembers.
    Number trendAlike{28};   ///< 1/16 px per frame by which a vector may be off its trend.
    Number halfReliable{6};  ///< Reliability of a vector that counts half.
    Number leastTrust{60};   ///< Of kFullReliability: less says nothing of a thing.
    Number stillDrift{8};    ///< 1/16 px per frame by which something may be off that stands.
  } layers;

  /// Fitting boxes of known sizes (core/objects/tracking/box_fit.hpp), in gains of a cell.
  struct Fit {
    Number foreground{4};  ///< What a cell of foreground gains.
    Number background{3};  ///< What another loses: a body fills some 60 % of its box.
    Number expected{2};    ///< More or less where a region is predicted to be this or another.
    Number core{1, 4};     ///< Of its width at either side, what lies outside of its middle.
    Number lift{4};        ///< By how much dearer a shift up or down is, squared.
    Number reachX{1, 2};   ///< Of its width, that a thing leaves its expected place by
    Number reachY{1, 5};   ///< and of its height, in `reach`.
    Number reach = ms(100);
    Number firstReachX{1};  ///< The same of what is new, whose speed is not known.
    Number firstReachY{1, 3};
    Number firstHits{3};       ///< Frames for which that holds.
    Number ownColour{1, 12};   ///< Share of a colour in a look from which it gains 2 more,
    Number someColour{1, 32};  ///< 1 more,
    Number fewColour{1, 100};  ///< nothing; one less below.
  } fit;

  /// Blobs that a track gives up (core/objects/tracking/ownership/parted_tracks.hpp).
  struct Parting {
    Number partCells{1, 4};   ///< Another blob is a thing, not a part, if so large, and it or the
    Number partOffset{1, 2};  ///< gap has moved by half of this share of the lesser width.
  } parting;

  /// The energy of whose a part of a region is (core/objects/tracking/ownership/
  /// track_terminals.hpp), in weights of a prediction, and of the appearance.
  struct Ownership {
    Number place{3};       ///< What a part inside of a track's box gains, in predictions.
    Number outside{1};     ///< What it loses just outside of it, in those of the place,
    Number most{2};        ///< and far away.
    Number spread{1, 16};  ///< Of its size, by which a thing's ends are off their places at least,
    Number sways{4};       ///< or so many times what it sways by.
    Number portrait{8};    ///< What a part gains that agrees with its portrait, and
    Number colour{4};      ///< what one in its own colours, in weights of the appearance.
  } ownership;

  /// Where a track is, and how fast.
  struct Place {
    Number trustedSamples{8};  ///< Frames after which a size is known.
    Number steadySamples{12};  ///< Frames over which a speed is steady.
    Number centreSamples{31};  ///< Frames over which the middle of its pixels is learnt.
    Number rigidSway{20};      ///< 1/256 of its size by which a rigid box changes; strides do more.
    Number offHeight{1, 4};    ///< What is about of a size is off its height by no more,
    Number offWidth{1, 2};     ///< nor its width: legs and arms change it more.
    Number cutRigid{11, 12};   ///< Of a rigid thing's width: less lacks an end.
    Number cutOther{10, 12};
    Number cutOneEnd{1, 4};     ///< The end that is there is off by less than that of the other.
    Number othersShare{1, 5};   ///< Of its box, owned by others: it isn't seen whole.
    Number allThere{15, 16};    ///< Of what usually agrees of a portrait: nothing is missing.
    Number seenAgain{1, 2};     ///< Of what it usually fills: it is seen,
    Number seenStill{77, 256};  ///< and so much if it was seen in the previous frame.
    Number sharpShare{1, 2};    ///< Of a portrait, that makes a match sharp,
    Number steadyShare{1, 4};   ///< and that counts for the steady speed.
    Number firstGain{16}, firstSpeed{14};  ///< 1/16 of what is off, of the first two sightings,
    Number earlyGain{14}, earlySpeed{8};   ///< the next two,
    Number wholeGain{11}, wholeSpeed{4};   ///< one that is seen whole,
    Number soleGain{8}, soleSpeed{1};      ///< in a blob of its own,
    Number otherGain{8}, otherSpeed{2};    ///< and otherwise.
    Number slowing{1, 2};  ///< A speed off its steady one by less is noise of the last moment.
  } place;

  /// Portraits: what a track looks like, pixel by pixel.
  struct Likeness {
    Number knownFrames{4};        ///< From which one can be looked for.
    Number faithful{160, 256};    ///< So much of a thing agrees that keeps its shape.
    Number leastAgreeing{8};      ///< Samples.
    Number leastShare{1, 200};    ///< Of a portrait, that has to agree,
    Number rigidShare{1, 32};     ///< and of what keeps its shape.
    Number agreeing{1, 2};        ///< Of what is seen of it.
    Number part{1, 2};            ///< Of what came out of it, that was a part of it.
    Number about{1, 8};           ///< By so much of its size a clear blob may be off.
    Number turnX{1, 3};           ///< Of its width, that a turn may carry it by,
    Number turnY{1, 6};           ///< and of its height.
    Number leastReach{6};         ///< Pixels that are always searched.
    Number mostReach{1, 8};       ///< Of the frame, that are searched at most.
    Number standing{3, 4};        ///< Of what usually agrees: it stands there.
    Number standingRegion{1, 2};  ///< Of a region, that it explains.
    Number edge{8};      ///< What a sample's edge gains that ends at the ground; a colour: 8.
    Number ground{2};    ///< What a sample loses where nothing is: a part may be hidden.
    Number distance{9};  ///< What a shift by its size costs, in samples' gains.
  } likeness;

  /// What no track explains.
  struct Newcomers {
    Number leastCells{4};        ///< Specks of fewer never count.
    Number sharedColumns{1, 2};  ///< Pieces of one body share so many of their columns,
    Number gap{1, 4};            ///< are no further apart, in heights,
    Number bodyHeight{5, 4};     ///< and together no higher than a thing of the scene,
    Number bodyWidth{3, 2};      ///< nor wider.
    Number fragment{1, 2};       ///< Of a body, that its piece has at most.
    Number atBorder{1, 8};       ///< Of a usual thing's area, that what comes in has at least,
    Number atBorderHeight{1, 3};
    Number outOf{1, 3};  ///< what comes out of a blob,
    Number outOfHeight{3, 5};
    Number outOfWidth{1, 2};
    Number alone{1, 5};  ///< and what appears by itself.
    Number aloneHeight{1, 2};
    Number aloneWidth{2, 5};
    Number ofParent{1, 2};  ///< Of what it comes out of, before the scene's sizes are known,
    Number ofKnown{1, 8};   ///< and where that has a size of its own.
    Number ofFrame{1, 3000};
    Number besideParent{1, 3};  ///< Of a parent's width, within which something comes out of it.
    Number usualWidth{3, 2};    ///< What begins with no more of a usual size gets that.
    Number usualHeight{7, 5};
  } newcomers;

  /// Newcomers that are a track which is missing, and who is who.
  struct Identity {
    Number leaveOut{1300};    ///< Cost of leaving one missing; distance and look cost up to 1000.
    Number gate{1, 2};        ///< Heights within which it comes back at once,
    Number gateGrowth{3, 2};  ///< and more of them for each second.
    Number part{4, 5};        ///< Of its width: less is a part of it.
    Number alike{2, 5};       ///< Similarity of looks without which it is somebody else.
    Number looks{4};          ///< Frames apart, after which two are judged.
    Number margin{1, 12};     ///< By so much the exchange has to look better.
  } identity;

  /// Sizes that are learnt.
  struct Sizes {
    Number off{1, 5};           ///< Of the larger: so far a size that is seen is off the track's.
    Number rigidSamples{24};    ///< Frames over which a size is learnt of what is rigid,
    Number uniformSamples{12};  ///< where all are of one size,
    Number otherSamples{4};     ///< and of others.
    Number widening{3};         ///< Times as slowly a width grows: strides and arms add to it.
    Number swaySamples{7};      ///< Over which it is learnt how much that changes.
    Number outgrown{5, 4};      ///< Of a size: more is more than the track.
    Number closing{1, 32};  ///< Of a box, by which an end comes nearer that goes behind something,
    Number closingPx{3};    ///< at least so many pixels.
    Number learnEvery{1, 2};   ///< Heights of way after which the scene learns again,
    Number learnFirst{1, 6};   ///< as long as it knows nothing.
    Number leastSamples{10};   ///< Of sizes, before the scene's are known.
    Number leastThings{8};     ///< Before they are said to be alike,
    Number alikeHeight{1, 4};  ///< off by no more,
    Number alikeWidth{9, 5};   ///< nor by this factor,
    Number mostUnlike{1, 4};   ///< but for this share of them.
    Number usual{1, 2};        ///< Of what a size is learnt from, the scene's says then.
  } sizes;

  /// Beginning, being hidden, stopping, ending.
  struct Life {
    Number confirm = ms(70);   ///< A new track is believed in once seen for so long,
    Number confirmHits{2};     ///< and so often.
    Number flicker = ms(250);  ///< One that is unseen for longer was nothing.
    Number doubled = ms(500);  ///< One body for so long, two tracks are one.
    Number miss = ms(400);     ///< Unseen for longer without a reason, it is lost.
    Number clutter = ms(500);  ///< What was there for a shorter time may be clutter.
    Number creep = ms(2000);   ///< What creeps more slowly is the shape of what left, which the
                               ///< background takes back from its borders.
    Number still = ms(1000);   ///< In one place for so long, it has stopped.
    Number leave{1, 6};        ///< Heights by which something has left its place,
    Number leaveNew{1, 3};     ///< and what appeared in the middle of the picture.
    Number travelled{1, 2};    ///< Widths from where it began that make it a thing for good.
    Number gone{1, 2};         ///< Of a box in the frame: of less, what is unseen has left.
    Number believed{1, 2};     ///< Of the time it was seen, for which it is thought to be hidden.
    Number coveredBy{2, 5};    ///< Of a box, by others before it: it is hidden.
    Number oneBodyColumns{3, 5};  ///< Two that are one body share so many of their columns,
    Number oneBodyRows{2, 5};     ///< no more of their rows,
    Number oneBodyGap{1, 4};      ///< are no further apart, in the lesser height,
    Number oneBodyHeight{5, 4};   ///< and together no higher than usual;
    Number oneBodyCells{5, 4};    ///< or show no more than one of them would,
    Number oneBodyShared{1, 2};   ///< in boxes that overlap by so much.
    Number settled = ms(100);     ///< Two that only brush each other for so long have not merged.
    Number clutterSome{8};        ///< Things that came and went, about two a second for long.
  } life;
};

}  // namespace rg::objects
