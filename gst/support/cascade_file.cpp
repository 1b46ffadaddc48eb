// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/cascade_file.hpp"

#include "gst/support/regular_file.hpp"

#include <glib.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

namespace rg {
namespace {

using detection::Cascade;

constexpr int64_t kMostMiB = 64;
constexpr size_t kMostNumbers = 1024;  ///< In one element: a tree's nodes.
constexpr size_t kMostTextBytes = 1U << 16;
constexpr size_t kDeepest = 16;

/// Why a file can't be read, thrown within this file only.
struct BadFile : std::runtime_error {
  using std::runtime_error::runtime_error;
};

[[noreturn]] void refuse(const std::string& why) {
  throw BadFile(why);
}

std::vector<double> numbersIn(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  std::vector<double> numbers;
  for (size_t at = text.find_first_not_of(kBlanks); at != std::string_view::npos;
       at = text.find_first_not_of(kBlanks, at)) {
    double number = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data() + at, end, number);
    if (error != std::errc{} || numbers.size() == kMostNumbers)
      refuse("there is something else where numbers are expected");
    numbers.push_back(number);
    at = static_cast<size_t>(stop - text.data());
  }
  return numbers;
}

int wholeOf(double number) {
  if (!(std::abs(number) <= std::numeric_limits<int16_t>::max()) || number != std::floor(number))
    refuse("a number is not whole, or too large");
  return static_cast<int>(number);
}

int oneWholeIn(std::string_view text) {
  const auto numbers = numbersIn(text);
  if (numbers.size() != 1) refuse("an element has not one number");
  return wholeOf(numbers[0]);
}

/// Follows the elements of a file and fills a cascade.
class CascadeReader {
 public:
  void open(std::string_view name, const char* typeId) {
    if (path_.size() == kDeepest) refuse("elements are nested too deeply");
    if (path_.size() < seen_.size() && std::exchange(seen_[path_.size()], true))
      refuse("it has more than one cascade");
    if (path_.size() == 1 && typeId && std::string_view(typeId) == "opencv-haar-classifier")
      refuse("it has OpenCV's format from before 2.4");
    path_.emplace_back(name);
    text_.clear();
    const std::string place = where();
    if (place == "stages/_") cascade_->stages.push_back({numberOf(cascade_->trees), 0, 0});
    if (place == "features/_") cascade_->features.emplace_back();
    if (place == "features/_/rects") rects_ = 0;
  }
  void add(std::string_view text) {
    if (text_.size() + text.size() > kMostTextBytes) refuse("an element has too long a text");
    text_ += text;
  }
  void close() {
    take(where());
    path_.pop_back();
    text_.clear();
  }

  std::shared_ptr<const Cascade> finish() {
    if (isHaar_ != 1 || isBoosted_ != 1)
      refuse("it is no boosted cascade of Haar features (stageType BOOST, featureType HAAR)");
    if (const auto checked = detection::check(*cascade_); !checked) refuse(checked.error().message);
    return std::move(cascade_);
  }

 private:
  /// The elements below that of the cascade, which may have any name.
  [[nodiscard]] std::string where() const {
    std::string place;
    for (size_t i = 2; i < path_.size(); ++i) place += (i > 2 ? "/" : "") + path_[i];
    return place;
  }
  template <class List>
  [[nodiscard]] static int32_t numberOf(const List& list) {
    return static_cast<int32_t>(list.size());
  }
  [[nodiscard]] std::string_view word() const {
    constexpr std::string_view kBlanks = " \t\r\n";
    const size_t first = text_.find_first_not_of(kBlanks);
    if (first == std::string::npos) return {};
    return std::string_view(text_).substr(first, text_.find_last_not_of(kBlanks) - first + 1);
  }

  void take(const std::string& place) {
    if (place == "stageType") isBoosted_ += word() == "BOOST" ? 1 : 2;
    if (place == "featureType") isHaar_ += word() == "HAAR" ? 1 : 2;
    if (place == "width") cascade_->window.width = oneWholeIn(text_);
    if (place == "height") cascade_->window.height = oneWholeIn(text_);
    if (place == "stages/_/stageThreshold") takeThreshold();
    if (place == "stages/_/weakClassifiers/_/internalNodes") takeNodes();
    if (place == "stages/_/weakClassifiers/_/leafValues") takeLeaves();
    if (place == "features/_/rects/_") takeRect();
    if (place == "features/_/tilted") cascade_->features.back().isTilted = oneWholeIn(text_) != 0;
  }
  void takeThreshold() {
    const auto numbers = numbersIn(text_);
    if (numbers.size() != 1) refuse("a stage has not one threshold");
    cascade_->stages.back().threshold = static_cast<float>(numbers[0]) - detection::kThresholdSlack;
  }
  /// Left, right, feature, threshold: a next place above 0 is a node, others are leaves.
  void takeNodes() {
    const auto numbers = numbersIn(text_);
    if (numbers.empty() || numbers.size() % 4 != 0) refuse("a tree has not four numbers a node");
    const int32_t nodes = static_cast<int32_t>(numbers.size() / 4);
    cascade_->trees.push_back({numberOf(cascade_->branches), nodes, numberOf(cascade_->leaves)});
    ++cascade_->stages.back().trees;
    for (size_t n = 0; n < numbers.size(); n += 4) {
      const auto next = [](double number) {
        const int place = wholeOf(number);
        return place > 0 ? place : place - 1;
      };
      cascade_->branches.push_back(
          {static_cast<float>(numbers[n + 3]), next(numbers[n]), next(numbers[n + 1])});
      cascade_->nodeFeatures.push_back(wholeOf(numbers[n + 2]));
    }
    if (cascade_->branches.size() > detection::kMostNodes) refuse("there are too many nodes");
  }
  void takeLeaves() {
    const auto numbers = numbersIn(text_);
    if (cascade_->trees.empty() ||
        numbers.size() != static_cast<size_t>(cascade_->trees.back().nodes) + 1 ||
        numberOf(cascade_->leaves) != cascade_->trees.back().firstLeaf)
      refuse("a tree has not one leaf more than nodes");
    for (const double number : numbers) cascade_->leaves.push_back(static_cast<float>(number));
  }
  void takeRect() {
    const auto n = numbersIn(text_);
    if (n.size() != 5) refuse("a rectangle has not five numbers");
    if (rects_ == detection::kMostRects) refuse("a feature has more than three rectangles");
    if (cascade_->features.size() > detection::kMostNodes) refuse("there are too many features");
    cascade_->features.back().rects[rects_++] = {
        {wholeOf(n[0]), wholeOf(n[1]), wholeOf(n[2]), wholeOf(n[3])}, static_cast<float>(n[4])};
  }

  std::shared_ptr<Cascade> cascade_ = std::make_shared<Cascade>();
  std::vector<std::string> path_;
  std::string text_;
  std::array<bool, 2> seen_{};  ///< The whole, and the cascade in it.
  size_t rects_ = 0;
  int isHaar_ = 0, isBoosted_ = 0;  ///< 1: said once, and so.
};

/// Between GLib's C and the reader: an exception waits until GLib has returned.
struct Parsing {
  CascadeReader reader;
  std::exception_ptr failure;

  template <class Step>
  static void go(gpointer data, GError** error, const Step& step) {
    auto& self = *static_cast<Parsing*>(data);
    try {
      step(self.reader);
    } catch (...) {
      self.failure = std::current_exception();
      g_set_error_literal(error, G_MARKUP_ERROR, G_MARKUP_ERROR_INVALID_CONTENT, "refused");
    }
  }
};

void startElement(GMarkupParseContext*, const char* name, const char** keys, const char** values,
                  gpointer data, GError** error) {
  const char* typeId = nullptr;
  for (; *keys; ++keys, ++values)
    if (std::string_view(*keys) == "type_id") typeId = *values;
  Parsing::go(data, error, [&](CascadeReader& reader) { reader.open(name, typeId); });
}
void endElement(GMarkupParseContext*, const char*, gpointer data, GError** error) {
  Parsing::go(data, error, [](CascadeReader& reader) { reader.close(); });
}
void addText(GMarkupParseContext*, const char* text, gsize bytes, gpointer data, GError** error) {
  Parsing::go(data, error, [&](CascadeReader& reader) { reader.add({text, bytes}); });
}

constexpr GMarkupParser kParser{startElement, endElement, addText, nullptr, nullptr};

struct FreeContext {
  void operator()(GMarkupParseContext* context) const { g_markup_parse_context_free(context); }
};
struct FreeError {
  void operator()(GError* error) const { g_error_free(error); }
};

std::shared_ptr<const Cascade> parse(std::string_view xml) {
  Parsing parsing;
  const std::unique_ptr<GMarkupParseContext, FreeContext> context(
      g_markup_parse_context_new(&kParser, GMarkupParseFlags{}, &parsing, nullptr));
  GError* raw = nullptr;
  const bool isRead = g_markup_parse_context_parse(context.get(), xml.data(),
                                                   static_cast<gssize>(xml.size()), &raw) &&
                      g_markup_parse_context_end_parse(context.get(), &raw);
  const std::unique_ptr<GError, FreeError> error(raw);
  if (parsing.failure) std::rethrow_exception(parsing.failure);
  if (!isRead) refuse("it is no XML: " + std::string(error ? error->message : "unknown"));
  return parsing.reader.finish();
}

Result<std::string> contentsOf(const std::string& path) {
  const Result<File> file = openRegular(path, kMostMiB);
  if (!file) return file.error();
  std::string contents;
  std::vector<char> block(size_t{1} << 16);
  while (const size_t count = std::fread(block.data(), 1, block.size(), file->get()))
    contents.append(block.data(), count);
  if (std::ferror(file->get())) return Error{"reading failed"};
  return contents;
}

}  // namespace

Result<std::shared_ptr<const Cascade>> parseCascade(std::string_view xml) {
  try {
    return parse(xml);
  } catch (const BadFile& why) {
    return Error{why.what()};
  }
}

Result<std::shared_ptr<const Cascade>> readCascade(const std::string& path) {
  auto contents = contentsOf(path);
  auto cascade =
      contents ? parseCascade(*contents) : Result<std::shared_ptr<const Cascade>>(contents.error());
  if (cascade) return cascade;
  return Error{"The cascade " + path + " can't be read (" + cascade.error().message +
               "): give the path of an OpenCV Haar cascade, as Debian's package opencv-data has "
               "them in /usr/share/opencv4/haarcascades"};
}

}  // namespace rg
