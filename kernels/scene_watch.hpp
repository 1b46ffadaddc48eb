// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/background/scene_watch.hpp: the sums that the host decides from.
#pragma once

#include "core/background/scene_watch.hpp"
#include "kernels/consensus_background.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

namespace rg::gpu::background {

/// Answers in device memory; isDark(), hasSwitchedColour() and bestShift() of core judge them.
void countLit(const Planes& picture, int level, rg::background::LitPoints* points, Stream stream);
/// Of a colour picture.
void countVivid(const Planes& picture, const ModelView& model, rg::background::VividPoints* points,
                Stream stream);
void sumShifted(const Planes& picture, const ModelView& model, Point centre,
                rg::background::ShiftedSums* sums, Stream stream);
void countFullFields(const BitView& raw, int* full, Stream stream);

/// In and out must differ.
void shiftPicture(Point shift, const Planes& picture, const PlaneTargets& out, Stream stream);

}  // namespace rg::gpu::background
