// All of limber that other programs include. What is reached from here is installed; everything else is the library's
// own and may change at any time.
#pragma once

// Errors, warnings, progress and cancelling.
#include "limber/core/error.h"
#include "limber/core/progress.h"

// Models and motions: files in, files out, and what is in them.
#include "limber/asset/asset.h"
#include "limber/asset/clip_io.h"
#include "limber/asset/export_fbx.h"
#include "limber/asset/geometry.h"
#include "limber/asset/mesh_asset.h"
#include "limber/asset/mesh_export.h"
#include "limber/asset/motion_io.h"
#include "limber/asset/pose_io.h"
#include "limber/asset/read.h"
#include "limber/asset/rig_io.h"
#include "limber/asset/write.h"
#include "limber/samples/sample_motions.h"
#include "limber/samples/samples.h"

// A rig, by names of methods; the methods themselves, on meshes.
#include "limber/mesh/prepare.h"
#include "limber/pipeline/auto_rig.h"
#include "limber/pipeline/report_json.h"
#include "limber/rigging/auto_rigger.h"
#include "limber/skinning/deformer.h"
#include "limber/skinning/weight_method.h"

// Poses and motions on it.
#include "limber/ik/ik_solver.h"
#include "limber/motion_mix/blend_motions.h"
#include "limber/motion_mix/crossfade_motions.h"
#include "limber/pipeline/combine_motions.h"
#include "limber/pipeline/pose_asset.h"
#include "limber/pipeline/retarget_asset.h"
#include "limber/pipeline/stand_upright.h"
#include "limber/retarget/retarget_method.h"
#include "limber/skeleton/clip.h"

// How good it is.
#include "limber/evaluate/model_quality.h"
#include "limber/evaluate/rig_metrics.h"
#include "limber/evaluate/weight_metrics.h"
