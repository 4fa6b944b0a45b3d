// The GPU's path on the host: the intersectors and forms of media that its kernels use, through render_pixel in a plain
// loop, and trees split over a queue as backend_cuda splits them. The integers are those of the CPU backend.
#include <gtest/gtest.h>

#include <type_traits>
#include <utility>

#include "cistula/bvh.h"
#include "cistula/small_scene.h"
#include "golden.h"
#include "scene/frame_view.h"
#include "scene/generated_scene.h"
#include "scene/put_pixels.h"
#include "scene/shadow_plan.h"
#include "scene/without_effect.h"

using namespace cistula;

namespace {

const std::string source = CISTULA_SOURCE_DIR;

template <class Entry>
struct Waiting {
    Entry branch;
    size_t record;
};

/// What backend_cuda's GivingBranchStack does: branches of `depth` and more go to the queue while that has room.
template <class Entry>
class GivingStack {
  public:
    using Queue = std::vector<Waiting<Entry>>;

    GivingStack(int depth, Queue& queue, size_t capacity, size_t record)
        : queue_(queue), capacity_(capacity), record_(record), depth_(depth) {}

    bool push(const Entry& branch) {
        if (int(branch.depth) >= depth_ && queue_.size() < capacity_) {
            queue_.push_back({branch, record_});
            return true;
        }
        if (pending_.size() == size_t(branch_stack)) return false;
        pending_.push_back(branch);
        return true;
    }
    bool pop(Entry& branch) {
        if (pending_.empty()) return false;
        branch = pending_.back();
        pending_.pop_back();
        return true;
    }

  private:
    Queue& queue_;
    std::vector<Entry> pending_;
    size_t capacity_, record_;
    int depth_;
};

/// Every pass follows trees `levels` further down; 0: to their end.
struct Split {
    int levels = 0;
    size_t capacity = ~size_t{0};

    int depth(int pass) const { return levels > 0 ? (pass + 1) * levels : largest_depth; }
};

/// A frame as a device renders it: a pass over pixels, then passes over what waits, here until nothing does and from
/// the last to the first. `given` counts the branches that went through a queue.
template <class Real, class E, class Scene, class Intersector>
void render_split(const Scene& scene, const FrameView& frame, const Intersector& intersector, Split split, Film& film,
                  uint64_t& given) {
    using Stack = GivingStack<BranchOf<Real, E, typename Intersector::Media>>;
    typename Stack::Queue queue, next;
    const size_t width = size_t(film.rect.width);
    for (size_t i = 0; i < film.pixels.size(); ++i) {
        // Where pixels have several samples, backend_cuda's threads share them.
        const int threads = frame.supersample > 1 ? 4 : 1;
        for (int thread = 0; thread < threads; ++thread) {
            Stack stack(split.depth(0), queue, split.capacity, i);
            PixelWork work;
            RecordOf<E> part;
            render_pixel<Real, E>(scene, frame, intersector, film.rect.x + int(i % width), film.rect.y + int(i / width),
                                  SampleRange{thread, threads}, part, work, stack);
            RecordOf<E>& record = film.pixels[i];
            if (thread > 0)
                record.add(part);
            else
                film.pixels[i] = whole_record(part);
            film.rays.add(work.rays);
            film.flags |= work.flags;
        }
    }
    for (int pass = 1; !queue.empty(); queue = std::exchange(next, {}), ++pass) {
        given += queue.size();
        for (size_t i = queue.size(); i-- > 0;) {
            PixelRecord part, &record = film.pixels[queue[i].record];
            Stack stack(split.depth(pass), next, split.capacity, queue[i].record);
            PixelWork work;
            resume_branch<Real, E>(scene, frame, intersector, queue[i].branch, part, work, stack);
            film.rays.add(work.rays);
            film.flags |= work.flags;
            record.add(part);
        }
    }
}

template <class Real, class Intersector>
Film render_as_device(const CompiledScene<Real>& compiled, const typename Intersector::Scene& scene,
                      const SceneDescription& description, const FrameSettings& settings, Split split,
                      uint64_t& given) {
    const SceneView<Real> view = compiled.view();
    const CameraFrame camera = camera_at(description.camera, 0);
    FrameView frame = frame_view(compiled, camera, settings);
    Film film;
    prepare_film(film, settings, compiled, camera);
    if (!camera_solids(view, BruteIntersector<Real>{view}, frame.camera.position, frame.camera_media))
        film.flags |= flag_media_overflow;
    const Intersector intersector{scene};
    // Few masks stand for all, which spares the compiler half of its work; tests of their own compare masks.
    constexpr int opaque = 1, middle = 3;
    const int least = least_mask(settings.effects | compiled.effects);
    if (least <= opaque)
        render_split<Real, Effects<effect_masks[opaque]>>(scene, frame, intersector, split, film, given);
    else if (least <= middle)
        render_split<Real, Effects<effect_masks[middle]>>(scene, frame, intersector, split, film, given);
    else
        render_split<Real, Effects<all_effects>>(scene, frame, intersector, split, film, given);
    return film;
}

struct Done {
    uint64_t given = 0;  // branches that went through a queue
    int plain_loops = 0;
};

template <class Real>
void check(const std::string& name, const SceneDescription& description, const FrameSettings& settings, Done& done) {
    const std::shared_ptr<CompiledScene<Real>> compiled = compile_scene<Real>(description);
    const auto embree = make_embree_renderer<Real>(compiled, {.always_tree = true});
    const Film expected = golden::render_with(*embree, description, settings);
    EXPECT_EQ(expected.flags, 0u) << name;
    // A budget of truncation is spent in the order of one stack, so such trees stay whole.
    std::vector<Split> splits = {{0}};
    if (settings.cutoff == 0) splits.insert(splits.end(), {{1}, {2}, {4}, {1, 7}});
    const auto expect_same = [&](const Film& film, const char* path, const Split& split) {
        const std::string where = name + ", " + path + ", split after levels: " + std::to_string(split.levels);
        EXPECT_EQ(film.flags, 0u) << where;
        EXPECT_EQ(film_hash(film), film_hash(expected)) << where;
        EXPECT_EQ(film.rays.primary, expected.rays.primary) << where;
        EXPECT_EQ(film.rays.reflected, expected.rays.reflected) << where;
        EXPECT_EQ(film.rays.transmitted, expected.rays.transmitted) << where;
        EXPECT_EQ(film.rays.shadow, expected.rays.shadow) << where;
    };
    using Tree = BvhIntersector<Real, MediaList>;
    using PlainLoop = BruteIntersector<Real, OneMedium, SmallScene<Real>>;
    const FacetTree<Real> tree = facet_tree(compiled->view());
    SceneView<Real> view = compiled->view();
    tree.put_into(view);
    const auto small = small_scene(view);
    for (const Split& split : splits) {
        expect_same(render_as_device<Real, Tree>(*compiled, view, description, settings, split, done.given), "tree",
                    split);
        if (!small) continue;
        ++done.plain_loops;
        expect_same(render_as_device<Real, PlainLoop>(*compiled, *small, description, settings, split, done.given),
                    "plain loop", split);
    }
}

template <class Real>
class DevicePathOnHost : public ::testing::Test {};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(DevicePathOnHost, Reals);

TYPED_TEST(DevicePathOnHost, GivesTheIntegersOfEveryGoldenScene) {
    Done done;
    for (const std::string& name : golden::scene_names(source + "/scenes")) {
        const SceneDescription scene = read_scene(source + "/scenes/" + name + ".json");
        FrameSettings settings = golden::settings_for(scene);
        settings.set_size(64, 36);
        settings.cutoff = 0;
        settings.depth = std::min(settings.depth, 8);
        check<TypeParam>(name, scene, settings, done);
        settings.crop = {25, 15, 9, 7};
        settings.depth = scene.depth;
        settings.cutoff = 0.01;
        check<TypeParam>(name + " with a cutoff", scene, settings, done);
    }
    // The camera in a solid, whose rays begin in a medium.
    SceneDescription scene = read_scene(source + "/scenes/benchmark.json");
    scene.camera = CameraDescription();
    for (const ObjectDescription& object : scene.objects)
        if (const auto* solid = std::get_if<SolidObject>(&object.shape)) scene.camera.position = solid->center;
    FrameSettings settings = golden::settings_for(scene);
    settings.set_size(32, 32);
    check<TypeParam>("benchmark from within", scene, settings, done);
    EXPECT_GT(done.given, 1000u) << "hardly a tree was split";
    EXPECT_GT(done.plain_loops, 0);
    // Nothing that a ledger would be for.
    scene = read_scene(source + "/scenes/benchmark.json");
    for (const Effect effect : {effect_transmission, effect_reflection}) scene = without_effect(scene, effect).value();
    settings = golden::settings_for(scene);
    settings.set_size(64, 36);
    ASSERT_FALSE(sends_rays_on(compile_scene<TypeParam>(scene)->effects));
    check<TypeParam>("benchmark, opaque and dull", scene, settings, done);
    const int before = done.plain_loops;
    std::erase_if(scene.objects,
                  [](const ObjectDescription& object) { return !std::holds_alternative<SolidObject>(object.shape); });
    check<TypeParam>("its solids", scene, settings, done);
    EXPECT_GT(done.plain_loops, before);
}

TYPED_TEST(DevicePathOnHost, GivesTheIntegersOfGeneratedScenes) {
    Done done;
    for (uint64_t seed = 2; seed < generated_scene_count; seed += 6) {
        const SceneDescription scene = generated_scene(seed, source + "/scenes");
        check<TypeParam>("seed " + std::to_string(seed), scene, generated_settings(scene), done);
    }
    EXPECT_GT(done.given, 1000u) << "hardly a tree was split";
    EXPECT_GT(done.plain_loops, 0);
}

}  // namespace
