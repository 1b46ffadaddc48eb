// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/overlay/painter.hpp"

#include "core/text/text.hpp"
#include "gst/overlay/graph_view.hpp"

#include <gst/video/gstvideometa.h>

#include <utility>

namespace rg::overlay {
namespace {

using Block = std::shared_ptr<Image<uint32_t>>;

/// A buffer that shows the block's pixels and keeps the block.
GstBuffer* wrap(const Block& block) {
  auto* keeper = new Block(block);
  const ImageView<uint32_t> pixels = block->view();
  const auto bytes = static_cast<gsize>(pixels.strideBytes) * static_cast<gsize>(pixels.height());
  GstBuffer* buffer =
      gst_buffer_new_wrapped_full(GST_MEMORY_FLAG_READONLY, pixels.data, bytes, 0, bytes, keeper,
                                  [](gpointer used) { delete static_cast<Block*>(used); });
  gsize offset[GST_VIDEO_MAX_PLANES] = {};
  gint stride[GST_VIDEO_MAX_PLANES] = {static_cast<gint>(pixels.strideBytes)};
  gst_buffer_add_video_meta_full(
      buffer, GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_OVERLAY_COMPOSITION_FORMAT_RGB,
      static_cast<guint>(pixels.width()), static_cast<guint>(pixels.height()), 1, offset, stride);
  return buffer;
}

Box labelExtent(const Figure& figure, const Layout& layout) {
  return figure.text.empty() ? Box{} : intersect(figure.label, boundsOf(layout.map.to));
}

}  // namespace

void Painter::forget() {
  trails_.clear();
  grid_.clear();
  composition_.reset();
  pool_.drop();
}

void Painter::follow(const objects::Objects& objects, int64_t nowNs, double trailLengthS) {
  grid_.advance(objects);
  trails_.advance(objects, nowNs, static_cast<int64_t>(trailLengthS * GST_SECOND));
}

CompositionPtr Painter::paint(const Scene& scene, const Views& views) {
  const Layout layout = layOutAll(scene, views);
  int64_t sum = 0;
  for (const Box& extent : extents_) sum += extent.area();
  for (const Figure& figure : figures()) sum += labelExtent(figure, layout).area();
  if (hasGrid(scene, views) || hasGraphView(scene, views) || sum > scene.frame.area())
    paintWhole(scene, views, layout);
  else
    paintEach(layout);
  return std::move(composition_);
}

Layout Painter::layOutAll(const Scene& scene, const Views& views) {
  const Size madeFor = scene.objects ? scene.objects->size : scene.frame;
  const Layout layout{mapBetween(madeFor, scene.frame), views, styleFor(scene.frame, views.scale)};
  figureCount_ = 0;
  extents_.clear();
  if (!views.caption.empty()) {
    layOutCaption(views.caption, layout, nextFigure());
    extents_.emplace_back();
  }
  if (!scene.objects || !views.any()) return layout;
  for (const objects::Object& object : scene.objects->objects) {
    if (!objects::isListed(object.state)) continue;
    Figure& figure = nextFigure();
    layOut(object, layout, trails_, figure);
    extents_.push_back(extentOf(figure, layout));
  }
  placeLabels(figures(), layout);
  return layout;
}

bool Painter::hasGrid(const Scene& scene, const Views& views) const {
  return views.grid && scene.objects && !grid_.size().isEmpty() &&
         scene.objects->size == grid_.size();
}

Figure& Painter::nextFigure() {
  if (figureCount_ == figures_.size()) figures_.emplace_back();
  return figures_[figureCount_++];
}

void Painter::paintWhole(const Scene& scene, const Views& views, const Layout& layout) {
  Canvas canvas = addRectangle(boundsOf(scene.frame), layout.style);
  if (hasGrid(scene, views)) drawGrid(grid_, layout.map, canvas);
  drawGraphView(scene, views, canvas);
  for (const Figure& figure : figures()) draw(figure, layout, canvas);
  for (const Figure& figure : figures()) drawLabel(figure, canvas);
}

void Painter::paintEach(const Layout& layout) {
  for (size_t i = 0; i < figureCount_; ++i) {
    if (extents_[i].isEmpty()) continue;
    Canvas canvas = addRectangle(extents_[i], layout.style);
    draw(figures_[i], layout, canvas);
  }
  for (const Figure& figure : figures()) {
    const Box extent = labelExtent(figure, layout);
    if (extent.isEmpty()) continue;
    Canvas canvas = addRectangle(extent, layout.style);
    drawLabel(figure, canvas);
  }
}

Canvas Painter::addRectangle(const Box& box, const Style& style) {
  const Block block = pool_.take();
  block->resize({box.width, box.height});
  GstBuffer* buffer = wrap(block);
  GstVideoOverlayRectangle* rectangle = gst_video_overlay_rectangle_new_raw(
      buffer, box.x, box.y, static_cast<guint>(box.width), static_cast<guint>(box.height),
      GST_VIDEO_OVERLAY_FORMAT_FLAG_PREMULTIPLIED_ALPHA);
  gst_buffer_unref(buffer);
  if (composition_)
    gst_video_overlay_composition_add_rectangle(composition_.get(), rectangle);
  else
    composition_.reset(gst_video_overlay_composition_new(rectangle));
  gst_video_overlay_rectangle_unref(rectangle);
  return {block->view(), {box.x, box.y}, style};
}

}  // namespace rg::overlay
