// SPDX-License-Identifier: LGPL-2.1-or-later
// Made-up scenes with known truth through the five stages, without GStreamer.
#include "core/objects/objects.hpp"
#include "core/text/names.hpp"
#include "tests/accuracy/earlier_stages.hpp"
#include "tests/accuracy/hardships.hpp"
#include "tests/accuracy/painter.hpp"
#include "tests/accuracy/sampling.hpp"
#include "tests/accuracy/verdict.hpp"
#include "tests/support/digest.hpp"
#include "tests/support/value_of.hpp"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>

namespace rg::truth {
namespace {

struct Options {
  bool isPan = false;
  bool explains = false;
  bool isDigest = false;
  uint32_t firstSeed = 1, lastSeed = 20;
  int least = 0;  ///< Scenes without a fault.
  Sampling sampling;
  Hardships hardships;
  std::string background;  ///< A .y4m file; empty: a yard that follows from the seed.
  std::string pictures;    ///< A folder for frames with the boxes of truth and report.
  int every = 25;          ///< Of these, one in so many frames.
};

constexpr char kUsage[] =
    "usage: scenes [--pan [--zoom PERCENT] [--roll DEGREES] [--cover PERCENT]\n"
    "              [--parallax PERCENT]] [--gate N] [--seeds FIRST:LAST] [--size WxH] [--fps F]\n"
    "              [--noise S] [--explain] [--digest] [--background FILE.y4m] [--pictures FOLDER]\n"
    "              [--every N]\n"
    "  --pan         the camera moves and bgremove is left out (default: it stands still)\n"
    "  --zoom        the picture also grows and shrinks, by at most so much a frame at 25 a "
    "second,\n"
    "                0 to 20, and up to half as large again (default: 0)\n"
    "  --roll        the camera also turns to and fro, by at most so much a frame at 25 a second,\n"
    "                0 to 20, and up to 30 degrees either way (default: 0)\n"
    "  --cover       large things cover so much of the frame on average, 0 to 35 (default: 0, a "
    "few\n"
    "                small ones)\n"
    "  --parallax    posts and hedges are nearer than the ground and move by so much faster with\n"
    "                the pan, 0 to 100 (default: 0, there are none); reports of them are false\n"
    "  --gate        exit 1 when fewer than N scenes are without a fault\n"
    "  --seeds       which scenes (default: 1:20)\n"
    "  --size        of the frames (default: 640x480); a seed is the same scene at every size of\n"
    "                one shape, and at every rate\n"
    "  --fps         frames a second, 1 to 1000 (default: 25)\n"
    "  --noise       standard deviation of each pixel, in grey levels (default: 4)\n"
    "  --explain     tell which number each actor had when\n"
    "  --digest      only tell of each seed a number that follows from frames and truth\n"
    "  --background  what the scene is painted on (default: a yard that follows from the seed)\n"
    "  --pictures    write frames there: the truth's boxes white, the reported ones coloured\n"
    "  --every       one frame in so many, for the digest and the pictures (default: 25)\n";

class Pipeline {
 public:
  Pipeline(bool isPan, double fps)
      : context_{std::make_shared<Executor>(0), {}},
        earlier_(context_, isPan, fps),
        objects_(objects::makeStage(context_)) {}

  std::shared_ptr<const objects::Objects> process(const bench::RawFrame& raw) {
    const auto motion = earlier_.process(raw);
    return earlier_.shown(valueOf(objects_->process(motion, {}, earlier_.time())));
  }

 private:
  Context context_;
  EarlierStages earlier_;
  std::unique_ptr<objects::Stage> objects_;
};

void outline(bench::RawFrame& frame, const Box& box, const std::array<uint8_t, 3>& colour) {
  const Box bounds = boundsOf(frame.layout.size);
  const auto put = [&](int x, int y) {
    if (bounds.contains({x, y}))
      std::copy(colour.begin(), colour.end(),
                frame.bytes.begin() + 3 * (int64_t{y} * bounds.width + x));
  };
  for (int x = box.x; x < box.right(); ++x) {
    put(x, box.y);
    put(x, box.bottom() - 1);
  }
  for (int y = box.y; y < box.bottom(); ++y) {
    put(box.x, y);
    put(box.right() - 1, y);
  }
}

/// A .ppm of the frame. Its buffer is drawn upon.
void writePicture(const std::string& path, bench::RawFrame& frame, const Scene& scene,
                  const objects::Objects& objects) {
  Image<uint16_t> room;
  const ImageView<const uint16_t> slots = objects.slots.unpacked(room);
  for (int y = 0; y < slots.height(); ++y)
    for (int x = 0; x < slots.width(); ++x)
      if (slots.at(x, y) != 0) {
        uint8_t& green =
            frame.bytes[3 * (static_cast<size_t>(y) * static_cast<size_t>(slots.width()) +
                             static_cast<size_t>(x)) +
                        1];
        green = static_cast<uint8_t>(std::min(255, green + 60));
      }
  for (const Fact& fact : scene.facts)
    outline(frame,
            {static_cast<int>(fact.box.x), static_cast<int>(fact.box.y),
             static_cast<int>(fact.box.width), static_cast<int>(fact.box.height)},
            {255, 255, 255});
  for (const objects::Object& object : objects.objects) {
    const uint32_t hash = mixHash(static_cast<uint32_t>(object.id), 0, 5);
    const auto strong = [&](int shift) { return static_cast<uint8_t>(hash >> shift & 255); };
    if (objects::isListed(object.state))
      outline(frame, object.box, {strong(0), strong(8), strong(16)});
    else if (object.state == objects::ObjectState::New)
      outline(frame, object.box, {0, 0, 0});
  }
  std::ofstream file(path, std::ios::binary);
  file << "P6\n" << frame.layout.size.width << ' ' << frame.layout.size.height << "\n255\n";
  file.write(reinterpret_cast<const char*>(frame.bytes.data()),
             static_cast<std::streamsize>(frame.bytes.size()));
}

Painter painterOf(const Options& options, uint32_t seed) {
  const Size planned = plannedFrame(options.sampling.size);
  Plan drawn = options.isPan ? hardened(planPan(seed, planned), seed, options.hardships)
                             : planStill(seed, planned);
  Plan plan = sampled(std::move(drawn), options.sampling);
  auto canvas = options.background.empty() ? makeYard(seed, plan.canvas, plan.scale)
                                           : valueOf(openClip(options.background, plan.canvas));
  return {std::move(plan), std::move(canvas), seed};
}

Figures play(const Options& options, uint32_t seed) {
  Painter painter = painterOf(options, seed);
  Pipeline pipeline(options.isPan, options.sampling.fps);
  Verdict verdict;
  bench::RawFrame frame;
  Scene scene;
  for (int number = 0; painter.next(frame, scene); ++number) {
    const auto objects = pipeline.process(frame);
    verdict.add(scene, *objects);
    if (!options.pictures.empty() && number % options.every == 0) {
      char name[64];
      std::snprintf(name, sizeof name, "/seed%u_%05d.ppm", seed, number);
      writePicture(options.pictures + name, frame, scene, *objects);
    }
  }
  if (options.explains) verdict.explain(std::cout);
  return verdict.figures();
}

bool isGood(const Figures& f, bool isPan) {
  if (isPan) return f.cameraPx <= 0.25 && f.recall >= 0.95 && f.falsePerFrame <= 0.05;
  return f.idf1 >= 1;
}

void tellDigest(const Options& options, uint32_t seed) {
  Painter painter = painterOf(options, seed);
  testing::Digest digest;
  bench::RawFrame frame;
  Scene scene;
  while (painter.next(frame, scene)) {
    digest.add({reinterpret_cast<const char*>(frame.bytes.data()), frame.bytes.size()});
    digest.add(scene.cameraDx);
    digest.add(scene.cameraDy);
    for (const Fact& fact : scene.facts)
      for (const double value : {fact.box.x, fact.box.y, fact.box.width, fact.box.height,
                                 fact.centroidX, fact.centroidY, fact.visible})
        digest.add(value);
    painter.skip(options.every - 1);
  }
  std::printf("seed %u: %016llx\n", seed, static_cast<unsigned long long>(digest.value()));
}

int run(const Options& options) {
  if (options.isDigest) {
    for (uint32_t seed = options.firstSeed; seed <= options.lastSeed; ++seed)
      tellDigest(options, seed);
    return 0;
  }
  int good = 0, count = 0;
  double corners = 0, centroid = 0, worst = 0, idf1 = 0, found = 0, falseBoxes = 0;
  for (uint32_t seed = options.firstSeed; seed <= options.lastSeed; ++seed) {
    const Figures f = play(options, seed);
    std::printf("seed %u: IDF1 %.4f, found %.4f, false %.3f per frame", seed, f.idf1, f.recall,
                f.falsePerFrame);
    if (options.isPan)
      std::printf(", camera %.3f (worst %.3f) px, corners %.4f", f.cameraPx, f.cameraWorstPx,
                  f.corners);
    std::printf(", centroid %.2f px, hidden %.2f (worst %.2f) px%s\n", f.centroidPx, f.hiddenPx,
                f.hiddenWorstPx, isGood(f, options.isPan) ? "" : "  <-");
    std::fflush(stdout);
    good += isGood(f, options.isPan);
    idf1 += f.idf1;
    found += f.recall;
    falseBoxes += f.falsePerFrame;
    corners += f.corners;
    centroid += f.centroidPx;
    worst = std::max(worst, f.hiddenWorstPx);
    ++count;
  }
  const int scenes = std::max(count, 1);
  std::printf("good=%d of %d\nidf1=%.4f\nfound=%.4f\nfalse_per_frame=%.4f\n", good, count,
              idf1 / scenes, found / scenes, falseBoxes / scenes);
  std::printf("centroid_px=%.3f\nhidden_worst_px=%.2f\n", centroid / scenes, worst);
  if (options.isPan) std::printf("corners=%.4f\n", corners / scenes);
  return good < options.least ? 1 : 0;
}

bool readNumber(const char* text, double least, double most, double& number) {
  return std::sscanf(text, "%lf", &number) == 1 && number >= least && number <= most;
}

bool parse(int argc, char** argv, Options& options) {
  Size& size = options.sampling.size;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    const char* value = i + 1 < argc ? argv[i + 1] : "";
    if (name == "--pan")
      options.isPan = true;
    else if (name == "--explain")
      options.explains = true;
    else if (name == "--digest")
      options.isDigest = true;
    else if (++i == argc)
      return false;
    else if (name == "--background")
      options.background = value;
    else if (name == "--pictures")
      options.pictures = value;
    else if (name == "--gate" && std::sscanf(value, "%d", &options.least) == 1)
      continue;
    else if (name == "--every" && std::sscanf(value, "%d", &options.every) == 1)
      continue;
    else if (name == "--seeds" &&
             std::sscanf(value, "%u:%u", &options.firstSeed, &options.lastSeed) == 2)
      continue;
    else if (name == "--size" && std::sscanf(value, "%dx%d", &size.width, &size.height) == 2)
      continue;
    else if (name == "--fps" && std::sscanf(value, "%lf", &options.sampling.fps) == 1)
      continue;
    else if (name == "--zoom" && readNumber(value, 0, 20, options.hardships.zoomPercent))
      continue;
    else if (name == "--roll" && readNumber(value, 0, 20, options.hardships.rollDegrees))
      continue;
    else if (name == "--cover" && readNumber(value, 0, 35, options.hardships.coverPercent))
      continue;
    else if (name == "--parallax" && readNumber(value, 0, 100, options.hardships.parallaxPercent))
      continue;
    else if (name == "--noise" && std::sscanf(value, "%lf", &options.sampling.noise) == 1)
      continue;
    else
      return false;
  }
  if (!options.isPan && !options.hardships.isPlain()) return false;
  return size.width >= 64 && size.height >= 64 && options.every > 0 && options.sampling.fps >= 1 &&
         options.sampling.fps <= 1000 && options.sampling.noise >= 0;
}

}  // namespace
}  // namespace rg::truth

int main(int argc, char** argv) {
  rg::truth::Options options;
  if (!rg::truth::parse(argc, argv, options)) {
    std::cerr << rg::truth::kUsage;
    return 2;
  }
  return rg::truth::run(options);
}
