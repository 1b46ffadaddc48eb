// SPDX-License-Identifier: LGPL-2.1-or-later
// Stage 1, element bgremove: which pixels are foreground (paper, section 2.2.1).
//
// Determinism: integers only; every pixel's model is its own, sums over the frame commute. The same
// bits for any number of threads. Areas are sorted by their first pixel in raster order.
#pragma once

#include "core/background/interest.hpp"
#include "core/base/camera/camera_motion.hpp"
#include "core/base/geometry.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/memory/result_plane.hpp"
#include "core/base/picture.hpp"
#include "core/base/result.hpp"
#include "core/base/stage.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace rg::background {

/// Values of a foreground mask.
inline constexpr uint8_t kBackgroundPixel = 0;
inline constexpr uint8_t kShadowPixel = 128;
inline constexpr uint8_t kForegroundPixel = 255;

enum class SceneEvent : uint8_t {
  None,
  LightSwitched,   ///< Most of the picture changed its brightness at once.
  ColourSwitched,  ///< It lost its colour, or got some: day and night view. The model starts anew.
  CameraMoved,     ///< Another scene for good, also where the camera was covered: the same.
  CameraShaken,    ///< The camera was pushed by a few pixels; told once a second at most.
  TooDark,         ///< Nothing can be seen: no foreground, nothing is learnt, until it is
  BrightAgain,     ///< bright again.
  ModelLost,       ///< A device was lost with the model in it, which starts anew on the CPU.
  CameraStarted,  ///< The camera goes somewhere: no foreground is told, nothing is learnt, until it
  CameraStopped,  ///< stands still again. The model starts anew.
};

/// Does the picture look otherwise from this frame on?
[[nodiscard]] constexpr bool isAnotherView(SceneEvent event) {
  return event == SceneEvent::LightSwitched || event == SceneEvent::ColourSwitched ||
         event == SceneEvent::CameraMoved || event == SceneEvent::CameraStarted ||
         event == SceneEvent::CameraStopped;
}

struct Scene {
  SceneEvent event = SceneEvent::None;  ///< What happened in this very frame.
  uint32_t foregroundPx = 0;
  bool isDark = false;          ///< Since TooDark, until BrightAgain.
  bool isCameraMoving = false;  ///< Since CameraStarted, until CameraStopped, or as was asked for.
  Point shift;  ///< By how much the camera looks off the model in this frame, in pixels.
};

/// What bgremove says of one frame. Immutable once published.
struct Foreground {
  Size size;
  Status status = Status::Skipped;
  std::shared_ptr<const Picture> picture;  ///< What was looked at; later stages look at it too.
  ResultPlane<uint8_t> mask;               ///< kBackgroundPixel, kShadowPixel, kForegroundPixel.
  Box extent;                              ///< Outside of it the mask is background.
  std::vector<Box> areas;  ///< Bounding boxes of the foreground's 8-connected parts.
  std::shared_ptr<const Image<uint8_t>> interest;  ///< As in the parameters.
  Scene scene;
  CameraMotion camera;                         ///< Since `cameraSince`, where it was looked for.
  std::shared_ptr<const Picture> cameraSince;  ///< None where it was not.

  void dropSources() {
    picture.reset();
    cameraSince.reset();
    interest.reset();
  }
};

enum class Method : uint8_t {
  Hybrid,           ///< Multi-modal model, hysteresis, shadow and ghost removal.
  Paper,            ///< Section 2.2.1 to the letter.
  FrameDifference,  ///< Section 2.1: what changed since the frame before, and what stopped since.
};

/// Whether the camera moves.
enum class Camera : uint8_t {
  Auto,    ///< Decided from frame to frame, by method hybrid; the others take it to stand still.
  Still,   ///< It stands still, or sways and comes back.
  Moving,  ///< Nothing is foreground.
};

/// Where method frame-difference looks. Both find the same, bit for bit.
enum class SearchScope : uint8_t {
  Frame,  ///< Everywhere.
  Areas,  ///< Where things were, and in the rows whose turn it is.
};

/// Which histogram method frame-difference takes its threshold from.
enum class ThresholdSource : uint8_t {
  Difference,  ///< That of the differences from the frame before.
  Frame,       ///< That of the frame itself, as section 2.1 says.
};

struct Params {
  Method method = Method::Hybrid;
  Camera camera = Camera::Still;
  int trainingFrames = 50;      ///< Frames from which the first model is learnt. 1 … 65535.
  double learningTimeS = 10.0;  ///< Time constant of the running update, in seconds.
  int threshold = 0;  ///< Least difference of a channel, in grey levels; 0 = found by the method.
  bool findsShadows = true;   ///< Mark cast shadows instead of counting them as foreground.
  double absorbTimeS = 60.0;  ///< After so many seconds a thing that stopped becomes background.
  /// Where to look (core/background/interest.hpp), of the picture's size; none = everywhere.
  std::shared_ptr<const Image<uint8_t>> interest;
  // Of method frame-difference:
  SearchScope search = SearchScope::Areas;
  int searchInterval =
      16;  ///< Every row is searched for new things once in so many frames. 1 … 64.
  ThresholdSource thresholdFrom = ThresholdSource::Difference;
};

class Stage {
 public:
  virtual ~Stage() = default;
  /// Transactional: on an error the model is as it was; after an exception as after
  /// reset(Reset::Stream). The picture's size may change only after that.
  [[nodiscard]] virtual Result<std::shared_ptr<const Foreground>> process(
      std::shared_ptr<const Picture> picture, const Params& params, FrameTime time) = 0;
  virtual void reset(Reset what) = 0;
};

[[nodiscard]] std::unique_ptr<Stage> makeStage(Context context);

}  // namespace rg::background
