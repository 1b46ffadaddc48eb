// SPDX-License-Identifier: LGPL-2.1-or-later
// The command line that the benchmarks share.
#pragma once

#include "core/base/geometry.hpp"
#include "core/base/result.hpp"
#include "core/segmentation/segmentation.hpp"

#include <span>
#include <string>

namespace rg::bench {

/// Frames before those that are measured, unless told otherwise: the background model is learnt by
/// then.
inline constexpr int kWarmUpFrames = 60;

/// Where frames come from, unless a file is given.
enum class SceneKind : uint8_t {
  Any,        ///< Clip where there is one, else Synthetic.
  Clip,       ///< Real frames with noise.
  Synthetic,  ///< Tiles and bodies of one colour each.
};

struct Options {
  std::string input;  ///< A video; empty = a scene.
  SceneKind scene = SceneKind::Any;
  std::string pattern;  ///< Instead of a scene: one of patternNames().
  Size size{640, 480};  ///< Of the scene.
  int regions = 160;    ///< In the synthetic scene, and the most that hsvsegment may make.
  int shiftPx = 20;     ///< Searched by prmmotion; things in the scene move by up to half of it.
  int threads = 0;      ///< 0 = all cores.
  int frames = 50;      ///< Measured, after a warm-up.
  int warmUp = kWarmUpFrames;
  bool asksTable = false;    ///< Measure the paper's sizes and numbers of regions.
  int minAreaPx = 0;         ///< Of regions; 0 = by the frame's size.
  int similarity = 2;        ///< Of neighbours in one region, in grey levels.
  int connectivity = 4;      ///< Of the graph, 4 or 8.
  bool asksWorst = false;    ///< Compare frames made to be expensive with those of the scene.
  bool asksExtreme = false;  ///< The settings that cost most: as many and as small regions as can
                             ///< be, all 8 neighbours, the longest shifts.
  bool asksCpu = false;      ///< Measure the processor's time, not the wall's.
  std::string backend = "cpu";  ///< Or cuda: the stages that can do so work on a GPU.
  int device = 0;               ///< Which GPU.
  int streams = 0;         ///< So many pipelines at once, of one thread each; 0 = one pipeline.
  bool isLiteral = false;  ///< The paper's own system, literally, in place of ours.
  segmentation::Scope scope = segmentation::Scope::Frame;  ///< Foreground: as behind bgremove.
  bool asksHelp = false;                                   ///< Print the usage and do nothing.
};

/// Errors name the option that is unknown, lacks its value or is out of range.
[[nodiscard]] Result<Options> parseOptions(std::span<const char* const> arguments);

[[nodiscard]] std::string usage(const std::string& program);

/// What the benchmarks' main() does with its arguments, the program's name the first of them.
/// Returns the exit status.
[[nodiscard]] int runProgram(std::span<char* const> arguments, int (*run)(const Options&));

}  // namespace rg::bench
