// Rays and segments in scene coordinates, as Renderer takes them, and their answers, as backends find them in the
// scene's frame.
#pragma once

#include "cistula/transport/ray_query.h"
#include "render/renderer.h"
#include "scene/compile/compiled_scene.h"

namespace cistula {

/// Answers each of `questions`; all are valid.
template <class Answer>
using Answerer = std::function<void(std::span<const RayQuestion> questions, std::span<Answer> answers)>;

/// Renderer::intersect() by a backend's function. Throws Error (usage) with the number of the first ray that is none.
template <class Real>
RayHits ray_hits(const CompiledScene<Real>& scene, std::span<const glm::dvec3> origins,
                 std::span<const glm::dvec3> directions, const Answerer<RayAnswer>& answer);

/// Renderer::transmittance() by a backend's function. Throws as ray_hits() does.
template <class Real>
std::vector<glm::dvec3> segment_shares(const CompiledScene<Real>& scene, std::span<const glm::dvec3> from,
                                       std::span<const glm::dvec3> to, const Answerer<glm::dvec3>& answer);

}  // namespace cistula
