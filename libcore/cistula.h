// The public headers of the libraries; docs/library.md has examples. What else these include is internal: it is
// installed, and may change with any version.
#pragma once

// cistula::scene: scenes from files to arrays, pictures and their files
#include "base/error.h"                     // what every function throws
#include "image/exr/exr.h"                  // write_exr, read_exr
#include "image/picture/picture.h"          // ColorPicture, LayeredPicture
#include "image/picture/picture_io.h"       // write_preview, read_texture
#include "image/picture/stored_picture.h"   // StoredFile, stored_file: pictures as they are compared
#include "image/reader/picture_reader.h"    // StoredReader
#include "render/pixel_report.h"            // pixel_text, pixel_json
#include "render/record/film.h"             // Film
#include "render/record/film_picture.h"     // to_layers, to_color
#include "render/record/frame_header.h"     // header_attributes
#include "render/renderer.h"                // FrameSettings, frame_settings, Renderer
#include "render/scene.h"                   // Scene
#include "scene/assets/assets.h"            // load_assets; MeshData: a mesh as arrays
#include "scene/description/camera_path.h"  // camera_at
#include "scene/description/description.h"  // SceneDescription
#include "scene/readers/read_scene.h"       // read_scene

// cistula::embree, cistula::cuda: renderers
#include "backend_cuda/host/cuda_renderer.h"        // make_cuda_renderer
#include "backend_embree/embree/embree_renderer.h"  // make_embree_renderer

// cistula::sequence: image sequences
#include "sequence/backends.h"         // make_renderer
#include "sequence/merge.h"            // tiles put together
#include "sequence/render_sequence.h"  // render_sequence

// cistula::compare: pictures and suites
#include "compare/metrics/compare.h"  // compare_files
#include "compare/suite/suite_run.h"  // run_cases

// cistula::verify: the renderer checks itself
#include "verify/verify.h"  // verify::run
