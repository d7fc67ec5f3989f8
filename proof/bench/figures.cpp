// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <type_traits>

#include "bench/chain/chains.hpp"
#include "bench/chain/recipe.hpp"
#include "core/test_support_allocations.hpp"
#include "gpu/device/dispatch.hpp"
#include "rows.hpp"

namespace darkroom::bench {

namespace {

// While it lives, what a recording calls of the driver does nothing: what is left is the library's own cost.

class NullCommands {
  public:
    explicit NullCommands(gpu::Dispatch& vk) : vk_(vk), kept_(vk) {
        drop(vk.UpdateDescriptorSets, vk.CmdBindPipeline, vk.CmdBindDescriptorSets, vk.CmdPipelineBarrier2,
             vk.CmdDispatch, vk.CmdBeginRendering, vk.CmdEndRendering, vk.CmdSetViewport, vk.CmdSetScissor, vk.CmdDraw,
             vk.CmdCopyBufferToImage, vk.CmdClearColorImage, vk.CmdResetQueryPool, vk.CmdWriteTimestamp2);
        vk.CmdBeginDebugUtilsLabelEXT = nullptr;
        vk.CmdEndDebugUtilsLabelEXT = nullptr;
    }
    ~NullCommands() { vk_ = kept_; }
    NullCommands(const NullCommands&) = delete;
    NullCommands& operator=(const NullCommands&) = delete;

  private:
    template <class... Arguments>
    static void drop_one(void (*&function)(Arguments...)) {
        function = [](Arguments...) {};
    }
    template <class... Functions>
    static void drop(Functions&... functions) {
        (drop_one(functions), ...);
    }
    gpu::Dispatch& vk_;
    gpu::Dispatch kept_;
};

const Row* find_row(const std::vector<Row>& rows, std::string_view name) {
    const auto found = std::ranges::find(rows, name, &Row::name);
    return found == rows.end() ? nullptr : &*found;
}

/// A ratio of two rows of the table and the most it should be; or, where a row is named to take off, of what the row
/// costs more than that one.
struct Target {
    std::string_view name, row, unit;
    std::optional<double> at_most{};
    std::string_view less{};
};
constexpr std::string_view hand_written = "tail/hand-written/";
/// A row against the fastest of those whose names begin so.
struct Race {
    std::string_view name, row, others;
    double at_most;
};
constexpr std::array races{
    Race{"tail fused / hand-written", "tail/fused/auto", hand_written, 1.25},
    // Forms that cost the same differ by what a busy machine adds.
    Race{"gaussian, radius 4 / its fastest form", "gaussian/4/automatic/auto", "gaussian/4/", 1.1},
    Race{"gaussian, radius 16 / its fastest form", "gaussian/16/automatic/auto", "gaussian/16/", 1.1},
    Race{"gaussian, radius 64 / its fastest form", "gaussian/64/automatic/auto", "gaussian/64/", 1.1},
};
constexpr std::array targets{
    Target{"the sun's soft shadows, dungeon / without", dungeon_scene_name, dungeon_unshadowed_name},
    Target{"the sun's plain shadows, dungeon / without", dungeon_plain_name, dungeon_unshadowed_name},
    Target{"lamps' shadows, street / without", street_name, street_unshadowed_name},
    Target{"calibration / plain copy", calibration_name, "copy/plain/raster"},
    Target{"tail fused / calibration", "tail/fused/auto", calibration_name, 3.0},
    Target{"tail fused / tail unfused", "tail/fused/auto", "tail/unfused/auto", 0.35},
    Target{"tail fused / tail unfused, compute", "tail/fused/compute", "tail/unfused/compute"},
    Target{"tail fused / tail unfused, raster", "tail/fused/raster", "tail/unfused/raster"},
    Target{"tail compute / hand-written compute", "tail/fused/compute", "tail/hand-written/compute"},
    Target{"tail raster / hand-written raster", "tail/fused/raster", "tail/hand-written/raster"},
    Target{"tail compute / plain compute", "tail/fused/compute", "tail/hand-written/plain/compute"},
    Target{"tail raster / plain raster", "tail/fused/raster", "tail/hand-written/plain/raster"},
    Target{"bloom / calibration", "bloom/auto", calibration_name, 5.5},
    Target{"bloom / calibration, compute", "bloom/compute", calibration_name},
    Target{"bloom / calibration, raster", "bloom/raster", calibration_name},
    Target{"default stack / calibration", "default/fused/auto", calibration_name, 8.5},
    Target{"default stack / calibration, compute", "default/fused/compute", calibration_name},
    Target{"default stack / calibration, raster", "default/fused/raster", calibration_name},
    // What a stack pays for an effect.
    Target{"ssao, hemisphere", "ssao/half/hemisphere", calibration_name, 5.0, "effect/encode"},
    Target{"ssao, ground truth", "ssao/half/ground_truth", calibration_name, 5.0, "effect/encode"},
    Target{"ssao, hemisphere, all given", "ssao/half/hemisphere, all given", calibration_name, {}, "effect/encode"},
    Target{"ssao, ground truth, all given", "ssao/half/ground_truth, all given", calibration_name, {}, "effect/encode"},
    Target{"ssao, full size, hemisphere", "ssao/full/hemisphere", calibration_name, {}, "effect/encode"},
    Target{"ssao, full size, ground truth", "ssao/full/ground_truth", calibration_name, {}, "effect/encode"},
    Target{"volumetric", "volumetric/auto", calibration_name, 5.5, "effect/encode"},
    Target{"volumetric, all given", "volumetric/auto, all given", calibration_name, {}, "effect/encode"},
    Target{"motion blur, half size", "motion_blur/half", calibration_name, 8.0, "effect/encode"},
    Target{"motion blur, half size, all given", "motion_blur/half, all given", calibration_name, {}, "effect/encode"},
    Target{"motion blur, full size", "motion_blur/full", calibration_name, {}, "effect/encode"},
    Target{"depth of field, half size", "depth_of_field/half", calibration_name, {}, "effect/encode"},
    Target{"depth of field, full size", "depth_of_field/full", calibration_name, {}, "effect/encode"},
    Target{"fxaa", "effect/fxaa", calibration_name, 4.0, "effect/encode"},
    Target{"fog in the tail", "tail/fog", calibration_name, 0.6, "tail/fused/auto"},
    Target{"fog in the tail, all given", "tail/fog, all given", calibration_name, {}, "tail/fused/auto"},
    Target{"lut in the tail", "tail/lut", calibration_name, 2.0, "tail/fused/auto"},
    Target{"interface in the tail, neutral", "tail/ui, neutral", calibration_name, 1.0, "tail/fused/auto"},
    Target{"interface in the tail, warp, chroma and echo on", "tail/ui", calibration_name, 5.0, "tail/fused/auto"},
    Target{"gaussian, radius 4", "gaussian/4/automatic/auto", calibration_name, 8.0, "effect/encode"},
    Target{"gaussian, radius 16", "gaussian/16/automatic/auto", calibration_name, {}, "effect/encode"},
    Target{"gaussian, radius 64", "gaussian/64/automatic/auto", calibration_name, {}, "effect/encode"},
    Target{"plain bloom / calibration", "plain bloom", calibration_name, 12.0},
    Target{"documented stack / calibration", "documented/fused/auto", calibration_name, 14.0},
    Target{"documented stack / calibration, all given", "documented/fused/auto, all given", calibration_name},
    Target{"documented stack / calibration, ground truth", "documented/ground_truth", calibration_name},
    Target{"documented stack / calibration, compute", "documented/fused/compute", calibration_name},
    Target{"documented stack / calibration, raster", "documented/fused/raster", calibration_name},
};

const Row* fastest_row(const std::vector<Row>& rows, std::string_view prefix, double Sample::*cost) {
    const Row* fastest = nullptr;
    for (const Row& row : rows)
        if (row.name.starts_with(prefix) &&
            (fastest == nullptr || median(column(row, cost)) < median(column(*fastest, cost))))
            fastest = &row;
    return fastest;
}

/// Of a frame of the dungeon, how much is post-processing.
std::optional<Figure> post_share(const std::vector<Row>& rows, double Sample::*cost) {
    const Row* const scene = find_row(rows, dungeon_scene_name);
    const Row* const post = find_row(rows, dungeon_post_name);
    if (scene == nullptr || post == nullptr) return std::nullopt;
    const double of_scene = ratio(*post, *scene, cost);
    return Figure{"dungeon, post-processing share", 100 * of_scene / (1 + of_scene), "%"};
}

double megabytes(std::uint64_t bytes) { return static_cast<double>(bytes) / 1e6; }

}  // namespace

std::vector<Figure> ratio_figures(const Device& device, const std::vector<Row>& rows) {
    double Sample::*const cost = cost_of(device);
    std::vector<Figure> figures;
    for (const Race& race : races) {
        const Row* const row = find_row(rows, race.row);
        const Row* const fastest = fastest_row(rows, race.others, cost);
        if (row != nullptr && fastest != nullptr)
            figures.push_back({std::string(race.name), ratio(*row, *fastest, cost), "", race.at_most});
    }
    for (const Target& target : targets) {
        const Row* const row = find_row(rows, target.row);
        const Row* const unit = find_row(rows, target.unit);
        const Row* const less = target.less.empty() ? nullptr : find_row(rows, target.less);
        if (row == nullptr || unit == nullptr || (less == nullptr && !target.less.empty())) continue;
        figures.push_back({std::string(target.name),
                           less == nullptr ? ratio(*row, *unit, cost) : difference(*row, *less, *unit, cost),
                           target.unit == calibration_name ? "c" : "", target.at_most});
    }
    if (const std::optional<Figure> share = post_share(rows, cost)) figures.push_back(*share);
    return figures;
}

Result<std::vector<Figure>> picture_figures(Bed& bed, const std::vector<Row>& rows) {
    DARKROOM_TRY_VALUE(auto submitter, Submitter::create(bed.context));
    const Row* const tail = find_row(rows, "tail/fused/auto");
    std::vector<Figure> figures;
    for (const Row& row : rows) {
        if (tail == nullptr || !row.name.starts_with(hand_written)) continue;
        std::array<std::vector<std::byte>, 2> pictures;
        for (std::size_t i = 0; i < pictures.size(); ++i) {
            DARKROOM_TRY(submitter->run((i == 0 ? *tail : row).record));
            DARKROOM_TRY_VALUE(auto picture, bed.read_target());
            pictures[i] = std::move(picture);
        }
        int worst = 0;
        for (std::size_t i = 0; i < pictures[0].size(); ++i)
            worst =
                std::max(worst, std::abs(std::to_integer<int>(pictures[0][i]) - std::to_integer<int>(pictures[1][i])));
        figures.push_back(
            {"tail fused - " + row.name.substr(5) + ", worst pixel", static_cast<double>(worst), "codes", 1.0});
    }
    return figures;
}

namespace {

/// Of the documented chain with warm caches: the same compile again, and one for half the extent.
Result<std::vector<Figure>> compile_figures(Bed& bed) {
    const Stack stack = documented_stack();
    if (stack.empty()) return std::vector<Figure>{};
    DARKROOM_TRY_VALUE(auto chain, compile_chain(bed, stack, {.world = WorldUse::WithoutNormals}));
    std::array<std::vector<double>, 2> milliseconds;
    for (int i = 0; i < 20; ++i) {
        CompileDesc desc = chain.compiled_for;
        if (i % 4 >= 2) desc.max_extent = {desc.max_extent.width / 2, desc.max_extent.height / 2};
        const auto start = std::chrono::steady_clock::now();
        DARKROOM_TRY(chain.composer->compile(desc));
        const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
        milliseconds[i % 2].push_back(time.count());
    }
    return std::vector<Figure>{{"compile again, documented chain", median(milliseconds[1]), "ms", 3.0},
                               {"compile for another extent, documented chain", median(milliseconds[0]), "ms", 3.0}};
}

/// What a host pays at compile for the effects of the flat table that it keeps although they are off: the stack of all
/// of them to that of a look's defaults, each in a new Composer, with warm caches.
Result<std::vector<Figure>> kept_figures(Bed& bed) {
    DARKROOM_TRY(bed.make_world());
    std::array<std::vector<double>, 2> milliseconds;
    for (int i = 0; i < 40; ++i) {
        const bool keeps_what_is_off = i % 2 != 0;
        Composer composer(bed.device, {.frames_in_flight = 1});
        fill(composer, flat_stack(keeps_what_is_off));
        const Stopwatch watch;
        DARKROOM_TRY(composer.compile(bed.compile_desc(WorldUse::Full)));
        // The first of each warms the caches.
        if (i >= 2) milliseconds[i % 2].push_back(watch.elapsed().wall_ms);
    }
    const double alone = median(milliseconds[0]), kept = median(milliseconds[1]);
    return std::vector<Figure>{{"compile, flat table", alone, "ms"},
                               {"compile, flat table with all that is off / without", kept / alone, "", 1.5}};
}

/// A pulse that is under way and a layer on every number of the stack.
Result<> modulate(Composer& composer) {
    LayerDesc layer{.name = "layer", .weight = 0.5f, .values = {}};
    for (std::size_t i = 0; i < composer.size(); ++i) {
        const Handle entry = composer.entry(i);
        for (const ParamInfo& row : composer.info(entry)->parameters.rows) {
            if (row.kind != Kind::Float) continue;
            const std::string parameter(row.name);
            DARKROOM_TRY(composer.add_pulse({.event = "hit", .entry = entry, .parameter = parameter}));
            layer.values.push_back({entry, parameter, {composer.words(entry)[row.word]}});
        }
    }
    composer.fire("hit", 0.0);
    return composer.add_layer(layer);
}

}  // namespace

Result<std::vector<Figure>> counted_figures(Bed& bed) {
    const Stack stack = default_stack();
    DARKROOM_TRY_VALUE(auto fused, compile_chain(bed, stack));
    DARKROOM_TRY_VALUE(auto unfused, compile_chain(bed, stack, {.fuse = false}));

    DARKROOM_TRY_VALUE(auto submitter, Submitter::create(bed.context));
    // The first recording uploads tables, so it is not one of a frame loop.
    constexpr int recordings = 20;
    std::vector<double> microseconds;
    std::uint64_t allocations = 0;
    for (int i = 0; i <= recordings; ++i) {
        DARKROOM_TRY_VALUE(auto commands, submitter->begin());
        const Frame frame = bed.frame();
        const std::uint64_t before = test::allocation_count();
        const auto recorded = fused.composer->record(commands, frame);
        const std::uint64_t made = test::allocation_count() - before;
        if (!recorded) return failure(recorded.error());
        auto ended = bed.context.check(bed.context.vk.EndCommandBuffer(commands), "ending a command buffer");
        if (ended) ended = submitter->submit();
        if (ended) ended = submitter->wait();
        if (!ended) return failure(std::move(ended));
        if (i == 0) continue;
        allocations += made;
        microseconds.push_back(fused.composer->record_microseconds());
    }
    const auto own_time = [&]() -> Result<double> {
        std::vector<double> own;
        const NullCommands null(bed.context.vk);
        for (int i = 0; i < 10 * recordings; ++i) {
            DARKROOM_TRY(fused.composer->record(VK_NULL_HANDLE, bed.frame()));
            own.push_back(fused.composer->record_microseconds());
        }
        return median(own);
    };
    DARKROOM_TRY_VALUE(const auto own, own_time());
    DARKROOM_TRY(modulate(*fused.composer));
    DARKROOM_TRY_VALUE(const auto modulated, own_time());
    DARKROOM_TRY_VALUE(auto again, compile_figures(bed));
    DARKROOM_TRY_VALUE(const auto kept, kept_figures(bed));
    std::vector<Figure> figures{
        {"record, default stack", median(microseconds), "us"},
        {"record, default stack: without the driver", own, "us", 15.0},
        {"pulses: one and a layer on each number of that stack", modulated - own, "us"},
        {"transient memory, default stack fused", megabytes(fused.plan.transient_bytes), "MB"},
        {"transient memory, default stack unfused", megabytes(unfused.plan.transient_bytes), "MB"},
    };
    // The validation layer allocates in every call.
    if (bed.context.messenger == VK_NULL_HANDLE)
        figures.push_back({"record, default stack: allocations", static_cast<double>(allocations), "", 0.0});
    if (unfused.plan.transient_bytes_unaliased > 0)
        figures.push_back({"transient memory unfused / sum of its images",
                           static_cast<double>(unfused.plan.transient_bytes) /
                               static_cast<double>(unfused.plan.transient_bytes_unaliased),
                           "", 0.45});
    if (const Stack bloom = bloom_stack(); !bloom.empty()) {
        DARKROOM_TRY_VALUE(auto alone, compile_chain(bed, bloom));
        if (alone.plan.transient_bytes > 0)
            figures.push_back(
                {"transient memory fused / that of bloom alone",
                 static_cast<double>(fused.plan.transient_bytes) / static_cast<double>(alone.plan.transient_bytes), "",
                 1.0});
    }
    figures.insert(figures.end(), again.begin(), again.end());
    figures.insert(figures.end(), kept.begin(), kept.end());
    return figures;
}

}  // namespace darkroom::bench
