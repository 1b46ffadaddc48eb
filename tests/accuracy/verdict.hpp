// SPDX-License-Identifier: LGPL-2.1-or-later
// How well reported objects agree with what is true.
#pragma once

#include "core/objects/objects.hpp"
#include "core/objects/tracking/assignment.hpp"
#include "tests/accuracy/painter.hpp"

#include <cstdint>
#include <map>
#include <ostream>
#include <set>
#include <vector>

namespace rg::truth {

struct Figures {
  double idf1 = 0;           ///< 0 … 1.
  double mota = 0;           ///< 1 less the share of misses, false boxes and exchanged numbers.
  double recall = 0;         ///< Share of what is to be found that a box with IoU ≥ 0.5 finds.
  double falsePerFrame = 0;  ///< Boxes that fit nothing.
  double centroidPx = 0;     ///< Mean distance, of what is at least 90 % visible.
  double hiddenPx = 0;       ///< Mean distance, of what is less visible and moves steadily.
  double hiddenWorstPx = 0;
  double cameraPx = 0;  ///< Mean distance of the camera's motion.
  double cameraWorstPx = 0;
  double corners = 0;  ///< Share of frames whose camera is within 0.25 px at all four corners.
};

/// Compares frame by frame. To be found is what lies in the frame and isn't hidden altogether;
/// boxes around anything else are neither right nor wrong.
class Verdict {
 public:
  void add(const Scene& scene, const objects::Objects& objects);
  [[nodiscard]] Figures figures() const;
  /// For each actor which numbers it had when, and where boxes were that fit nothing.
  void explain(std::ostream& out) const;

 private:
  struct Mean {
    double sum = 0, most = 0;
    int count = 0;
    void add(double value);
    void add(const Mean& other);
    [[nodiscard]] double mean() const { return count == 0 ? 0 : sum / count; }
  };
  struct Pair {
    int matches = 0;
    Mean clear, hidden;
  };
  struct Span {
    int first = 0, last = 0;
    uint64_t id = 0;  ///< 0 = not found.
  };
  [[nodiscard]] std::set<uint64_t> pairedWithHidden(const Scene& scene,
                                                    const objects::Objects& objects);
  void note(int actor, uint64_t id);
  [[nodiscard]] std::map<int, uint64_t> bestPartners() const;
  [[nodiscard]] int64_t exchanges() const;

  std::map<std::pair<int, uint64_t>, Pair> pairs_;
  std::map<int, std::vector<Span>> spans_;
  std::map<uint64_t, std::vector<Span>> strays_;
  objects::Assignment assignment_;
  Mean camera_, corners_;
  int64_t facts_ = 0, reports_ = 0, found_ = 0, false_ = 0;
  int frames_ = 0;
};

}  // namespace rg::truth
