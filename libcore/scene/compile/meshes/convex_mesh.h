// Closed convex meshes with flat faces, as planes. Private to libcore/scene.
#pragma once

#include <optional>

#include "scene/compile/contacts/contacts.h"
#include "scene/compile/solids/compile_solids.h"

namespace cistula {

/// The largest mesh that is searched for planes, in triangles.
inline constexpr uint32_t most_convex_triangles = 4096;

/// The planes of a solid that is a mesh, if planes reproduce its surface (docs/rules.md, 3). None for Platonic solids,
/// for a mesh with a texture, one that keeps its triangles or has too many, and one that is not closed, not convex, not
/// flat-faced, too sharp or too thin. Slabs are in the order of their first triangles; faces that contacts put into a
/// plane have its number.
std::optional<ConvexSolid> convex_mesh(const SceneSource& source, uint32_t number,
                                       const SceneNormalization& normalization, const Contacts& contacts);

}  // namespace cistula
