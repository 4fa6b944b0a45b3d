// A part of a case after compilation, with its lists and what each intersector needs; runs the part's rays.
#pragma once

#include <memory>

#include "backend_embree/embree/embree_tree.h"
#include "verify/case.h"
#include "verify/lane_path.h"

namespace cistula::verify {

template <class Real>
class ReadyPart {
  public:
    /// `number`: of the part in its case. Once `stop` is given, tallies and words are of any number of rays.
    ReadyPart(const Part& part, uint64_t number, const Options& options, StopSignal stop);

    /// An expected warning that the scene did not give; empty: none is missing.
    std::string missing_warning() const;
    /// The number of rays for loops over all primitives: of large scenes they take the first rays only.
    uint64_t plain_count() const;
    /// Whether frames of the scene are traced in lanes.
    bool fits_lanes() { return lanes().fits(); }

    Tally tally(IntersectorKind by, const RayMethods<Real>& methods, uint64_t place, uint64_t count);
    std::vector<uint64_t> words(IntersectorKind by, const RayMethods<Real>& methods, uint64_t count);

  private:
    const LanePath<Real>& lanes();
    /// Calls body(intersector) with an intersector of the host.
    void with_intersector(IntersectorKind by, const std::function<void(const CalledIntersector<Real>&)>& body);

    const Part& part_;
    const Options& options_;
    const StopSignal stop_;
    std::unique_ptr<CompiledScene<Real>> compiled_;
    std::vector<Vec3<double>> points_;
    Numbers numbers_;
    Setup<Real> setup_;
    std::unique_ptr<EmbreeTree<Real>> embree_;
    std::unique_ptr<LanePath<Real>> lanes_;
};

}  // namespace cistula::verify
