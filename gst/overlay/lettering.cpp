// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/overlay/lettering.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <memory>
#include <pango/pangocairo.h>

namespace rg::overlay {
namespace {

/// Letters that are made of few strokes stay clear when they are small.
constexpr int kStrokes = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kCapitalPx = 21;  // Height of its capitals at scale 1.
/// Of a usual font's size its capitals take this share.
constexpr double kCapitalShare = 0.72;

bool isPlain(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

struct Strokes {
  double scale;
  int thickness;
};

Strokes strokesOf(const Style& style) {
  return {style.textPx / kCapitalPx, std::max(1, (style.textPx + 5) / 10)};
}

struct Unref {
  void operator()(gpointer object) const { g_object_unref(object); }
};
using LayoutPtr = std::unique_ptr<PangoLayout, Unref>;

LayoutPtr layOut(const std::string& text, const Style& style) {
  const std::unique_ptr<PangoContext, Unref> context(
      pango_font_map_create_context(pango_cairo_font_map_get_default()));
  LayoutPtr layout(pango_layout_new(context.get()));
  PangoFontDescription* font = pango_font_description_from_string("Sans");
  pango_font_description_set_absolute_size(font, style.textPx / kCapitalShare * PANGO_SCALE);
  pango_layout_set_font_description(layout.get(), font);
  pango_font_description_free(font);
  pango_layout_set_single_paragraph_mode(layout.get(), TRUE);
  gchar* valid = g_utf8_make_valid(text.data(), static_cast<gssize>(text.size()));
  pango_layout_set_text(layout.get(), valid, -1);
  g_free(valid);
  return layout;
}

void paint(cairo_surface_t* surface, cv::Point corner, PangoLayout* layout,
           const graph::Colour& colour) {
  cairo_t* cairo = cairo_create(surface);
  cairo_set_source_rgb(cairo, colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0);
  cairo_move_to(cairo, corner.x, corner.y);
  pango_cairo_show_layout(cairo, layout);
  cairo_destroy(cairo);
}

}  // namespace

Size letteringSize(const std::string& text, const Style& style) {
  if (isPlain(text)) {
    const auto [scale, thickness] = strokesOf(style);
    int baseline = 0;
    return {cv::getTextSize(text, kStrokes, scale, thickness, &baseline).width, style.textPx + 1};
  }
  Size size;
  pango_layout_get_pixel_size(layOut(text, style).get(), &size.width, &size.height);
  return size;
}

void drawLettering(cv::Mat& pixels, cv::Point corner, const std::string& text, const Style& style,
                   const graph::Colour& colour) {
  if (isPlain(text)) {
    const auto [scale, thickness] = strokesOf(style);
    const cv::Scalar ink(colour.blue, colour.green, colour.red, 255);
    cv::putText(pixels, text, corner + cv::Point(0, style.textPx), kStrokes, scale, ink, thickness,
                cv::LINE_AA);
    return;
  }
  // Cairo's pixels are words, whose bytes lie as OpenCV has them where the lowest comes first.
  static_assert(G_BYTE_ORDER == G_LITTLE_ENDIAN);
  cairo_surface_t* surface = cairo_image_surface_create_for_data(
      pixels.data, CAIRO_FORMAT_ARGB32, pixels.cols, pixels.rows, static_cast<int>(pixels.step[0]));
  paint(surface, corner, layOut(text, style).get(), colour);
  cairo_surface_finish(surface);
  cairo_surface_destroy(surface);
}

}  // namespace rg::overlay
