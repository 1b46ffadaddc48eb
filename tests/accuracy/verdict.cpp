// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/accuracy/verdict.hpp"

#include "core/objects/tracking/assignment.hpp"
#include "core/text/names.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace rg::truth {
namespace {

constexpr double kSeen = 0.1;   // Less is hidden.
constexpr double kClear = 0.9;  // Its centroid can be measured.
constexpr double kMatch = 0.5;  // IoU.
constexpr double kCornerPx = 0.25;
constexpr int kWithoutCamera = 2;  // Frames before the first motion that can be measured.

double sharedArea(const RealBox& a, const Box& b) {
  const double width = std::min(a.x + a.width, double(b.right())) - std::max(a.x, double(b.x));
  const double height = std::min(a.y + a.height, double(b.bottom())) - std::max(a.y, double(b.y));
  return width > 0 && height > 0 ? width * height : 0;
}

double overlap(const RealBox& a, const Box& b) {
  const double shared = sharedArea(a, b);
  return shared / (a.width * a.height + static_cast<double>(b.area()) - shared);
}

bool isToBeFound(const Fact& fact) {
  return fact.isInside && fact.visible >= kSeen;
}

double distance(const Fact& fact, const objects::Object& object) {
  return std::hypot(double(object.centroidX) / objects::kPositionUnit - fact.centroidX,
                    double(object.centroidY) / objects::kPositionUnit - fact.centroidY);
}

/// How far off the camera is at that of the frame's corners where it is off most, in pixels.
double worstCorner(const Scene& scene, const objects::Objects& objects) {
  constexpr double kUnit = 1 << CameraMotion::kPlaceBits;
  const Size size = scene.frame;
  double worst = 0;
  for (const int x : {0, size.width - 1})
    for (const int y : {0, size.height - 1}) {
      const Point told = objects.camera.before(x, y);
      const Place was = scene.before(x, y);
      worst = std::max(worst, std::hypot(told.x / kUnit - was.x, told.y / kUnit - was.y));
    }
  return worst;
}

}  // namespace

void Verdict::Mean::add(double value) {
  sum += value;
  most = std::max(most, value);
  ++count;
}

void Verdict::Mean::add(const Mean& other) {
  sum += other.sum;
  most = std::max(most, other.most);
  count += other.count;
}

void Verdict::note(int actor, uint64_t id) {
  std::vector<Span>& spans = spans_[actor];
  if (!spans.empty() && spans.back().id == id && spans.back().last == frames_ - 1)
    spans.back().last = frames_;
  else
    spans.push_back({frames_, frames_, id});
}

/// The listed objects that are paired with what is not to be found: as MOTChallenge does, they are
/// taken out before anything is counted.
std::set<uint64_t> Verdict::pairedWithHidden(const Scene& scene, const objects::Objects& objects) {
  std::vector<const objects::Object*> listed;
  for (const objects::Object& object : objects.objects)
    if (rg::objects::isListed(object.state)) listed.push_back(&object);
  constexpr int64_t kFull = 1'000'000;
  std::vector<int64_t> costs;
  for (const Fact& fact : scene.facts)
    for (const objects::Object* object : listed) {
      const double fit = overlap(fact.box, object->box);
      costs.push_back(fit >= kMatch ? std::llround(kFull * (1 - fit)) : objects::kForbidden);
    }
  assignment_.solve(costs, static_cast<int>(scene.facts.size()), static_cast<int>(listed.size()),
                    kFull);
  std::set<uint64_t> paired;
  for (size_t i = 0; i < scene.facts.size(); ++i) {
    const int column = assignment_.columnOf(static_cast<int>(i));
    if (column >= 0 && !isToBeFound(scene.facts[i]))
      paired.insert(listed[static_cast<size_t>(column)]->id);
  }
  return paired;
}

void Verdict::add(const Scene& scene, const objects::Objects& objects) {
  const std::set<uint64_t> removed = pairedWithHidden(scene, objects);
  std::set<uint64_t> fitting, excused;
  for (const Fact& fact : scene.facts) {
    uint64_t best = 0;
    double most = kMatch;
    for (const objects::Object& object : objects.objects) {
      const bool isListed = rg::objects::isListed(object.state) && !removed.contains(object.id);
      const double fit = overlap(fact.box, object.box);
      if (isListed && !isToBeFound(fact) &&
          2 * sharedArea(fact.box, object.box) >= static_cast<double>(object.box.area()))
        excused.insert(object.id);
      if (isListed && isToBeFound(fact) && fit >= kMatch) {
        fitting.insert(object.id);
        Pair& pair = pairs_[{fact.actor, object.id}];
        ++pair.matches;
        if (fact.visible >= kClear) pair.clear.add(distance(fact, object));
        if (fit > most) best = object.id;
        most = std::max(most, fit);
      }
      if (fact.isInside && fact.isSteady && fact.visible < kClear)
        pairs_[{fact.actor, object.id}].hidden.add(distance(fact, object));
    }
    if (!isToBeFound(fact)) continue;
    ++facts_;
    found_ += best != 0;
    note(fact.actor, best);
  }
  for (const objects::Object& object : objects.objects) {
    if (!rg::objects::isListed(object.state) || removed.contains(object.id)) continue;
    if (!fitting.contains(object.id) && excused.contains(object.id)) continue;
    ++reports_;
    if (fitting.contains(object.id)) continue;
    ++false_;
    std::vector<Span>& spans = strays_[object.id];
    if (!spans.empty() && spans.back().last == frames_ - 1)
      spans.back().last = frames_;
    else
      spans.push_back({frames_, frames_, object.id});
  }
  if (frames_ >= kWithoutCamera) {
    corners_.add(worstCorner(scene, objects) <= kCornerPx ? 1 : 0);
    camera_.add(std::hypot(double(objects.cameraDx) / motion::kMotionUnit - scene.cameraDx,
                           double(objects.cameraDy) / motion::kMotionUnit - scene.cameraDy));
  }
  ++frames_;
}

/// The one-to-one assignment of numbers to actors that has most matches.
std::map<int, uint64_t> Verdict::bestPartners() const {
  std::vector<int> actors;
  std::vector<uint64_t> ids;
  for (const auto& [key, pair] : pairs_) {
    if (std::find(actors.begin(), actors.end(), key.first) == actors.end())
      actors.push_back(key.first);
    if (std::find(ids.begin(), ids.end(), key.second) == ids.end()) ids.push_back(key.second);
  }
  std::sort(ids.begin(), ids.end());
  std::vector<int64_t> costs(actors.size() * ids.size(), objects::kForbidden);
  for (size_t a = 0; a < actors.size(); ++a)
    for (size_t i = 0; i < ids.size(); ++i) {
      const auto found = pairs_.find({actors[a], ids[i]});
      if (found != pairs_.end() && found->second.matches > 0)
        costs[a * ids.size() + i] = frames_ - found->second.matches;
    }
  objects::Assignment assignment;
  assignment.solve(costs, static_cast<int>(actors.size()), static_cast<int>(ids.size()), frames_);
  std::map<int, uint64_t> partners;
  for (size_t a = 0; a < actors.size(); ++a) {
    const int column = assignment.columnOf(static_cast<int>(a));
    if (column >= 0) partners[actors[a]] = ids[static_cast<size_t>(column)];
  }
  return partners;
}

/// How often an actor was found under another number than before.
int64_t Verdict::exchanges() const {
  int64_t count = 0;
  for (const auto& [actor, spans] : spans_) {
    uint64_t known = 0;
    for (const Span& span : spans) {
      if (span.id == 0) continue;
      count += known != 0 && span.id != known;
      known = span.id;
    }
  }
  return count;
}

Figures Verdict::figures() const {
  int64_t matches = 0;
  Mean clear, hidden;
  for (const auto& partner : bestPartners()) {
    const Pair& pair = pairs_.at(partner);
    matches += pair.matches;
    clear.add(pair.clear);
    hidden.add(pair.hidden);
  }
  Figures f;
  f.idf1 = facts_ + reports_ == 0 ? 1 : 2.0 * double(matches) / double(facts_ + reports_);
  if (facts_ > 0) f.mota = 1 - double(facts_ - found_ + false_ + exchanges()) / double(facts_);
  f.recall = facts_ == 0 ? 1 : double(found_) / double(facts_);
  f.falsePerFrame = frames_ == 0 ? 0 : double(false_) / frames_;
  f.centroidPx = clear.mean();
  f.hiddenPx = hidden.mean();
  f.hiddenWorstPx = hidden.most;
  f.cameraPx = camera_.mean();
  f.cameraWorstPx = camera_.most;
  f.corners = corners_.mean();
  return f;
}

void Verdict::explain(std::ostream& out) const {
  const auto partners = bestPartners();
  for (const auto& [actor, spans] : spans_) {
    out << "  actor " << actor << ':';
    for (const Span& span : spans) out << ' ' << span.first << '-' << span.last << " #" << span.id;
    if (const auto partner = partners.find(actor); partner != partners.end()) {
      const Pair& pair = pairs_.at(*partner);
      out << " | clear " << pair.clear.mean() << " px, hidden " << pair.hidden.mean() << " ("
          << pair.hidden.most << ") px";
    }
    out << '\n';
  }
  for (const auto& [id, spans] : strays_) {
    out << "  fits nothing: #" << id << " at";
    for (const Span& span : spans) out << ' ' << span.first << '-' << span.last;
    out << '\n';
  }
}

}  // namespace rg::truth
