// The public headers of cistula::scene: from a scene file to a compiled scene, from a film to files. A backend renders
// in between: backend_embree/embree/embree_renderer.h, backend_cuda/host/cuda_renderer.h. docs/library.md has an
// example. What else these include is internal: it is installed, and may change with any version.
#pragma once

#include "scene/assets/assets.h"                // load_assets; MeshData: a mesh as arrays
#include "scene/base/error.h"                   // what every function throws
#include "scene/compile/compiled_scene.h"       // compile_scene
#include "scene/compile/precision_choice.h"     // choose_precision: float or double
#include "scene/compile/scene_source.h"         // gather_scene
#include "scene/compile/smallest_part.h"        // smallest_part
#include "scene/description/camera_path.h"      // camera_at
#include "scene/description/description.h"      // SceneDescription
#include "scene/film/film.h"                    // Film
#include "scene/film/film_picture.h"            // to_layers, to_color
#include "scene/film/frame_header.h"            // header_attributes
#include "scene/film/frame_settings.h"          // frame_settings
#include "scene/film/renderer.h"                // FrameSettings, Renderer
#include "scene/image/exr/exr.h"                // write_exr
#include "scene/image/picture/picture.h"        // ColorPicture, LayeredPicture
#include "scene/image/picture/picture_io.h"     // write_preview, read_texture
#include "scene/image/reader/picture_reader.h"  // TexelArray: a texture as an array
#include "scene/readers/read_scene.h"           // read_scene
