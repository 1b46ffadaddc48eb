// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/interest.hpp"

#include "core/base/mapping.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>

namespace rg::background {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";
constexpr uint8_t kLeastWhite = 128;

/// Takes the text up to `separator` off the front of `rest`.
std::string_view takeUntil(std::string_view& rest, std::string_view separators) {
  const size_t end = std::min(rest.find_first_of(separators), rest.size());
  const std::string_view taken = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return taken;
}

std::string_view takeWord(std::string_view& rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
  return takeUntil(rest, kBlanks);
}

bool readShare(std::string_view text, int& to) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !(value >= 0 && value <= 1))
    return false;
  to = static_cast<int>(std::lround(value * InterestPolygon::kUnit));
  return true;
}

/// The beginning of a text, cut between characters of UTF-8.
std::string_view excerpt(std::string_view text) {
  constexpr size_t kMostBytes = 80;
  if (text.size() <= kMostBytes) return text;
  size_t end = kMostBytes;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return text.substr(0, end);
}

Error complaint(std::string_view area, std::string_view why) {
  std::string message(excerpt(area));
  message += message.size() < area.size() ? "... is no area: " : " is no area: ";
  message += why;
  message += ". Areas are written as 0,0.5 1,0.5 1,1 0,1; exclude 0.4,0.6 0.5,0.6 0.5,0.7";
  return {std::move(message)};
}

Error tooMany() {
  return {"more than " + std::to_string(kMostInterestPoints) + " points, or " +
          std::to_string(kMostInterestBytes) +
          " bytes of text: leave points out, or draw the areas into a picture and name it as mask"};
}

/// `left`: how many points it may have.
Result<InterestPolygon> parsePolygon(std::string_view text, size_t left) {
  InterestPolygon polygon;
  std::string_view rest = text;
  for (std::string_view word = takeWord(rest); !word.empty(); word = takeWord(rest)) {
    if (word == "exclude" && polygon.points.empty() && !polygon.isExcluded) {
      polygon.isExcluded = true;
      continue;
    }
    Point point;
    std::string_view y = word;
    const std::string_view x = takeUntil(y, ",");
    if (!readShare(x, point.x) || !readShare(y, point.y))
      return complaint(text, "its points lie between 0,0 and 1,1");
    if (polygon.points.size() == left) return tooMany();
    polygon.points.push_back(point);
  }
  if (polygon.points.size() < 3) return complaint(text, "it needs three points at least");
  return polygon;
}

/// First column whose centre lies at or right of the place where the edge a–b crosses the middle of
/// row y. Centres are (2 x + 1) / (2 width): in units of 2^-16 / (2 width) all are integers, and no
/// product exceeds 2^31 · 2^31.
int64_t crossing(Point a, Point b, int y, Size frame) {
  constexpr int64_t kUnit = InterestPolygon::kUnit;
  const int64_t middle = (2 * int64_t{y} + 1) * kUnit;
  const int64_t ay = int64_t{2} * frame.height * a.y, by = int64_t{2} * frame.height * b.y;
  const int64_t ax = int64_t{2} * frame.width * a.x, bx = int64_t{2} * frame.width * b.x;
  const int64_t x = ax + (bx - ax) * (middle - ay) / (by - ay);
  return std::clamp<int64_t>((x + kUnit - 1) / (2 * kUnit), 0, frame.width);
}

bool crosses(Point a, Point b, int y, int height) {
  const int64_t middle = (2 * int64_t{y} + 1) * InterestPolygon::kUnit;
  return (int64_t{2} * height * a.y <= middle) != (int64_t{2} * height * b.y <= middle);
}

void fill(const InterestPolygon& polygon, uint8_t value, ImageView<uint8_t> image) {
  std::vector<int64_t> ends;
  for (int y = 0; y < image.height(); ++y) {
    ends.clear();
    for (size_t i = 0; i < polygon.points.size(); ++i) {
      const Point a = polygon.points[i], b = polygon.points[(i + 1) % polygon.points.size()];
      if (crosses(a, b, y, image.height())) ends.push_back(crossing(a, b, y, image.size));
    }
    std::sort(ends.begin(), ends.end());
    for (size_t i = 0; i + 1 < ends.size(); i += 2)
      std::fill(image.row(y) + ends[i], image.row(y) + ends[i + 1], value);
  }
}

}  // namespace

Result<std::vector<InterestPolygon>> parsePolygons(std::string_view text) {
  if (text.size() > kMostInterestBytes) return tooMany();
  std::vector<InterestPolygon> polygons;
  size_t left = kMostInterestPoints;
  while (!text.empty()) {
    const std::string_view part = takeUntil(text, ";");
    if (part.find_first_not_of(kBlanks) == std::string_view::npos) continue;
    auto polygon = parsePolygon(part, left);
    if (!polygon) return polygon.error();
    left -= polygon->points.size();
    polygons.push_back(*std::move(polygon));
  }
  return polygons;
}

void drawInterest(std::span<const InterestPolygon> polygons, ImageView<const uint8_t> picture,
                  ImageView<uint8_t> interest) {
  const bool isWhole = std::all_of(polygons.begin(), polygons.end(),
                                   [](const InterestPolygon& p) { return p.isExcluded; });
  for (int y = 0; y < interest.height(); ++y)
    std::fill_n(interest.row(y), interest.width(), isWhole ? kInside : uint8_t{0});
  for (const bool isExcluded : {false, true})
    for (const InterestPolygon& polygon : polygons)
      if (polygon.isExcluded == isExcluded) fill(polygon, isExcluded ? 0 : kInside, interest);
  if (picture.size.isEmpty()) return;
  const FrameMap map{picture.size, interest.size};
  for (int y = 0; y < interest.height(); ++y)
    for (int x = 0; x < interest.width(); ++x)
      if (picture.at(map.sourceX(x), map.sourceY(y)) < kLeastWhite) interest.at(x, y) = 0;
}

}  // namespace rg::background
