// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/support/written_lines.hpp"

#include <csignal>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::Caps;
using testing::Chain;
using testing::MessagePtr;
using testing::paint;
using testing::square;

constexpr Size kSize{64, 48};

class RegionWrite : public testing::WrittenLines {
 protected:
  [[nodiscard]] std::string line(const std::string& more = "") const {
    return "regionwrite drop=false location=" + path_ + " " + more;
  }
};

BufferPtr frame(int index, std::shared_ptr<const objects::Objects> objects) {
  BufferPtr buffer = paint(Caps{}, index, square(1, 1, 5));
  if (objects) attachResult<objects::Objects>(buffer.get(), std::move(objects));
  return buffer;
}

auto oneObject() {
  return testing::objects(kSize, {testing::object(3, {10, 20, 8, 4})});
}

TEST_F(RegionWrite, PassesTheVeryBufferItGot) {
  Chain chain(line());
  BufferPtr in = frame(0, oneObject());
  const GstBuffer* sent = in.get();
  const auto bytes = testing::bytesOf(in.get());
  const BufferPtr out = chain.pass(std::move(in));
  ASSERT_EQ(out.get(), sent);
  EXPECT_EQ(testing::bytesOf(out.get()), bytes);
  EXPECT_TRUE(findResult<objects::Objects>(out.get()));
}

TEST_F(RegionWrite, WritesALineOfJsonAsSoonAsAFrameArrives) {
  Chain chain(line());
  ASSERT_TRUE(chain.pass(frame(0, oneObject())));
  const std::string first =
      R"({"schema":"1.0","frame":1,"pts":0,"status":"ok","resolution":{"width":64,"height":48},)"
      R"("camera":{"x":0.00,"y":0.00},"objects":[{"id":3,"state":"tracked","x":10,"y":20,"w":8,)"
      R"("h":4,"centroid":{"x":14.00,"y":22.00},"area":32,"velocity":{"x":16.00,"y":0.00},)"
      R"("age":1,"colour":"#000000","parents":[]}],"events":[]})"
      "\n";
  EXPECT_EQ(written(), first);
  ASSERT_TRUE(chain.pass(frame(1, oneObject())));
  EXPECT_NE(written().find("\n{\"schema\":\"1.0\",\"frame\":2,\"pts\":40000000,"),
            std::string::npos);
}

TEST_F(RegionWrite, WritesOutlinesWhenAsked) {
  Chain chain(line("contours=true"));
  ASSERT_TRUE(chain.pass(frame(0, oneObject())));
  EXPECT_NE(written().find(R"("contour":[[10,20],[17,20],[17,23],[10,23]])"), std::string::npos);
}

TEST_F(RegionWrite, WritesMotChallenge) {
  Chain chain(line("format=mot"));
  for (int i = 0; i < 2; ++i) ASSERT_TRUE(chain.pass(frame(i, oneObject())));
  EXPECT_EQ(written(), "1,3,10,20,8,4,1,-1,-1,-1\n2,3,10,20,8,4,1,-1,-1,-1\n");
}

TEST_F(RegionWrite, WritesRegionsUnderAHeader) {
  Chain chain(line("format=regions"));
  const std::string header = "frame,id,area,x,y,w,h,cx,cy,dx,dy,reliability,object\n";
  EXPECT_EQ(written(), header);
  BufferPtr buffer = frame(0, nullptr);
  attachResult<graph::Graph>(buffer.get(), testing::graph(kSize));
  ASSERT_TRUE(chain.pass(std::move(buffer)));
  EXPECT_EQ(written(), header +
                           "1,1,1536,0,0,32,48,15.50,23.50,0.0000,0.0000,0.0000,0\n"
                           "1,2,1536,32,0,32,48,47.50,23.50,0.0000,0.0000,0.0000,0\n");
}

TEST_F(RegionWrite, WritesTheGraphWithTheEnergyOfItsArcs) {
  Chain chain(line("format=graph"));
  auto motion = std::make_shared<motion::Motion>();
  motion->graph = testing::graph(kSize);
  motion->regions.resize(2);
  const std::shared_ptr<objects::Objects> objects = oneObject();
  objects->motion = motion;
  objects->regionObject = {3, 0};
  objects->regionExpected = {3, 3};
  objects->regionGroup = {objects::GroupIndex::ofIndex(0), objects::GroupIndex::ofIndex(1)};
  objects->arcs = {{512, 256, 128, 64}};
  ASSERT_TRUE(chain.pass(frame(0, objects)));
  EXPECT_NE(written().find(R"("energy":{"motion":0.00,"border":1.00,"arc":0.50,)"
                           R"("prediction":0.25,"total":1.75})"),
            std::string::npos);
  EXPECT_NE(written().find(R"("group":0,"expected":3,"object":3})"), std::string::npos);
  EXPECT_NE(written().find(R"("motion":2.00,"border":1.00,"arc":0.50,"prediction":0.25,)"
                           R"("weight":-0.25,"kept":false}]})"),
            std::string::npos);
}

TEST_F(RegionWrite, MapsToFramesThatWereScaled) {
  Chain chain(line("format=mot"), Caps{"GRAY8", 128, 24});
  BufferPtr buffer = paint(chain.caps(), 0, square(1, 1, 5));
  attachResult<objects::Objects>(buffer.get(), oneObject());
  ASSERT_TRUE(chain.pass(std::move(buffer)));
  EXPECT_EQ(written(), "1,3,20,10,16,2,1,-1,-1,-1\n");
}

TEST_F(RegionWrite, TellsTheTimeOfDayOnlyFromAReferenceTimestamp) {
  Chain chain(line());
  constexpr uint64_t kUnixNs = 1'700'000'000'000'000'000;
  constexpr uint64_t kNtpNs = kUnixNs + 2'208'988'800ull * GST_SECOND;
  ASSERT_TRUE(chain.pass(frame(0, oneObject())));
  EXPECT_EQ(written().find("utc"), std::string::npos);
  int index = 1;
  for (const auto& [name, ns] :
       {std::pair{"timestamp/x-unix", kUnixNs}, {"timestamp/x-ntp", kNtpNs}}) {
    BufferPtr buffer = frame(index++, oneObject());
    GstCaps* reference = gst_caps_new_empty_simple(name);
    gst_buffer_add_reference_timestamp_meta(buffer.get(), reference, ns, GST_CLOCK_TIME_NONE);
    gst_caps_unref(reference);
    ASSERT_TRUE(chain.pass(std::move(buffer)));
  }
  const std::string text = written();
  const std::string utc = R"("utc":"2023-11-14T22:13:20.000000000Z")";
  const auto first = text.find(utc);
  ASSERT_NE(first, std::string::npos);
  EXPECT_NE(text.find(utc, first + 1), std::string::npos);
}

TEST_F(RegionWrite, WritesNullForAFrameWithoutTime) {
  Chain chain(line());
  BufferPtr buffer = frame(0, oneObject());
  GST_BUFFER_PTS(buffer.get()) = GST_CLOCK_TIME_NONE;
  ASSERT_TRUE(chain.pass(std::move(buffer)));
  EXPECT_NE(written().find(R"("frame":1,"pts":null,)"), std::string::npos);
}

TEST_F(RegionWrite, NamesTheElementThatIsMissing) {
  for (const auto& [format, producer] :
       {std::pair{"jsonl", "mrfmerge"}, {"mot", "mrfmerge"}, {"regions", "srg"}}) {
    Chain chain(line(std::string("format=") + format));
    EXPECT_EQ(chain.push(frame(0, nullptr)), GST_FLOW_ERROR);
    EXPECT_NE(chain.complaint(GST_MESSAGE_ERROR).find(std::string("add ") + producer),
              std::string::npos);
  }
}

TEST_F(RegionWrite, StillCountsFramesWhoseResultsStopped) {
  Chain chain(line());
  ASSERT_TRUE(chain.pass(frame(0, oneObject())));
  for (int i = 1; i < 4; ++i) ASSERT_TRUE(chain.pass(frame(i, nullptr)));
  EXPECT_NE(chain.complaint(GST_MESSAGE_WARNING).find("mrfmerge"), std::string::npos);
  EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
  EXPECT_NE(written().find(R"("frame":4,"pts":120000000,"status":"skipped")"), std::string::npos);
}

TEST_F(RegionWrite, StartsAgainWithAnEmptyFileAndFrameOne) {
  Chain chain(line("format=mot"));
  GstElement* element = chain.element("regionwrite");
  for (int round = 0; round < 3; ++round) {
    ASSERT_TRUE(chain.pass(frame(0, oneObject())));
    EXPECT_EQ(written(), "1,3,10,20,8,4,1,-1,-1,-1\n");
    gst_element_set_state(element, GST_STATE_NULL);
    gst_element_set_state(element, GST_STATE_PLAYING);
    chain.setCaps(Caps{});
  }
  gst_object_unref(element);
}

TEST_F(RegionWrite, PostsWhyItCouldNotWrite) {
  Chain chain("regionwrite drop=false location=/dev/full");
  EXPECT_EQ(chain.push(frame(0, oneObject())), GST_FLOW_ERROR);
  const MessagePtr message = chain.message(GST_MESSAGE_ERROR);
  ASSERT_TRUE(message);
  GError* error = nullptr;
  gst_message_parse_error(message.get(), &error, nullptr);
  EXPECT_TRUE(g_error_matches(error, GST_RESOURCE_ERROR, GST_RESOURCE_ERROR_WRITE));
  EXPECT_STREQ(error->message, "Could not write to \"/dev/full\": No space left on device.");
  g_error_free(error);
}

/// Starts the element with a location that can't be opened; returns the error's text.
std::string startWith(const std::string& location) {
  GstElement* element = gst_element_factory_make("regionwrite", nullptr);
  GstBus* bus = gst_bus_new();
  gst_element_set_bus(element, bus);
  g_object_set(element, "location", location.c_str(), nullptr);
  EXPECT_EQ(gst_element_set_state(element, GST_STATE_PAUSED), GST_STATE_CHANGE_FAILURE);
  GstMessage* message = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR);
  GError* error = nullptr;
  std::string text;
  if (message) gst_message_parse_error(message, &error, nullptr);
  if (error) {
    EXPECT_TRUE(g_error_matches(error, GST_RESOURCE_ERROR, GST_RESOURCE_ERROR_OPEN_WRITE));
    text = error->message;
    g_error_free(error);
    gst_message_unref(message);
  }
  gst_element_set_state(element, GST_STATE_NULL);
  gst_element_set_bus(element, nullptr);
  gst_object_unref(bus);
  gst_object_unref(element);
  return text;
}

TEST_F(RegionWrite, FailsToStartWhereItCannotWrite) {
  EXPECT_EQ(startWith(path_ + "/there"),
            "Could not open \"" + path_ + "/there\" for writing: No such file or directory.");
  EXPECT_NE(startWith(folder_.string()).find("Is a directory"), std::string::npos);
  EXPECT_NE(startWith("").find("No such file"), std::string::npos);
}

TEST_F(RegionWrite, APipeWithoutAReaderIsAnErrorInsteadOfAHang) {
  ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
  EXPECT_NE(startWith(path_).find("nobody reads"), std::string::npos);
}

TEST_F(RegionWrite, AReaderThatGoesAwayIsAnErrorInsteadOfASignal) {
  ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
  const int reader = open(path_.c_str(), O_RDONLY | O_NONBLOCK);
  Chain chain(line("format=mot"));
  EXPECT_TRUE(chain.pass(frame(0, oneObject())));
  close(reader);
  EXPECT_EQ(chain.push(frame(1, oneObject())), GST_FLOW_ERROR);
  EXPECT_NE(chain.complaint(GST_MESSAGE_ERROR).find("Broken pipe"), std::string::npos);
}

/// The size that files of this process may have, for as long as it lives.
class FileLimit {
 public:
  explicit FileLimit(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{bytes, old_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileLimit() { setrlimit(RLIMIT_FSIZE, &old_); }
  FileLimit(const FileLimit&) = delete;
  FileLimit& operator=(const FileLimit&) = delete;

 private:
  rlimit old_{};
};

TEST_F(RegionWrite, ALimitOfFileSizesIsAnErrorInsteadOfASignal) {
  Chain chain(line("format=mot"));
  int index = 0;
  for (; index < 5; ++index) ASSERT_TRUE(chain.pass(frame(index, oneObject())));
  const std::string before = written();
  {
    const FileLimit limit(before.size() + 3);
    EXPECT_EQ(chain.push(frame(index, oneObject())), GST_FLOW_ERROR);
  }
  const std::string error = chain.complaint(GST_MESSAGE_ERROR);
  EXPECT_NE(error.find(std::to_string(before.size() + 3) + " bytes"), std::string::npos) << error;
  EXPECT_NE(error.find("ulimit -f"), std::string::npos) << error;
  EXPECT_EQ(written().substr(0, before.size()), before);
  sigset_t pending;
  sigpending(&pending);
  EXPECT_EQ(sigismember(&pending, SIGXFSZ), 0);
}

TEST_F(RegionWrite, AReaderThatDoesNotReadDoesNotStopTheElementFromStopping) {
  ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
  const int reader = open(path_.c_str(), O_RDONLY | O_NONBLOCK);
  GError* error = nullptr;
  GstElement* pipeline = gst_parse_launch(
      ("videotestsrc ! video/x-raw,format=GRAY8,width=64,height=48 ! hsvsegment ! srg ! " +
       line("format=regions") + " ! fakesink sync=false")
          .c_str(),
      &error);
  ASSERT_TRUE(pipeline);
  g_clear_error(&error);
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  g_usleep(500'000);  // Long enough to fill the pipe.
  EXPECT_EQ(gst_element_set_state(pipeline, GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
  gst_object_unref(pipeline);
  close(reader);
}

TEST_F(RegionWrite, TheFileIsNotHandedToChildProcesses) {
  Chain chain(line());
  int found = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    std::error_code error;
    if (std::filesystem::read_symlink(entry, error) != path_) continue;
    ++found;
    EXPECT_TRUE(fcntl(std::stoi(entry.path().filename()), F_GETFD) & FD_CLOEXEC);
  }
  EXPECT_EQ(found, 1);
}

}  // namespace
}  // namespace rg
