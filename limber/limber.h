// All of limber that other programs include. What is reached from here is installed; everything else is the library's
// own and may change at any time.
#pragma once

// Errors, warnings, progress and cancelling.
#include "limber/core/error.h"
#include "limber/core/progress.h"

// Models and motions: files in, files out, and what is in them.
#include "limber/character/character.h"
#include "limber/document/asset.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/fbx/export_fbx.h"
#include "limber/document/mesh/mesh_asset.h"
#include "limber/document/mesh/mesh_export.h"
#include "limber/document/read.h"
#include "limber/document/rig/pose_io.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/geometry.h"
#include "limber/document/write.h"
#include "limber/samples/motions/sample_motions.h"
#include "limber/samples/samples.h"

// A rig, by names of methods; the methods themselves, on meshes.
#include "limber/actions/report_json.h"
#include "limber/actions/rig/auto_rig.h"
#include "limber/deform/deformer.h"
#include "limber/geometry/mesh/prepare.h"
#include "limber/reading/shape_weights.h"
#include "limber/rigging/auto_rigger.h"
#include "limber/rigging/weights/weight_method.h"

// Poses and motions on it.
#include "limber/actions/motion/combine_motions.h"
#include "limber/actions/motion/retarget_asset.h"
#include "limber/actions/pose/pose_asset.h"
#include "limber/actions/rig/stand_upright.h"
#include "limber/motion/mix/blend_motions.h"
#include "limber/motion/mix/crossfade_motions.h"
#include "limber/motion/retarget/retarget_method.h"
#include "limber/skeleton/clip/clip.h"
#include "limber/skeleton/ik/ik_solver.h"

// How good it is.
#include "limber/evaluate/rig/model_quality.h"
#include "limber/evaluate/rig/rig_metrics.h"
#include "limber/evaluate/skin/weight_metrics.h"
