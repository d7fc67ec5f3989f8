// SPDX-License-Identifier: MIT
#include "edits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "edit/document.hpp"
#include "edit/test_random_edits.hpp"

namespace darkroom::bench {

namespace {

constexpr VkExtent2D edited_extent{320, 180};
/// The stack stays as long as people make them: adding and removing keep the balance between these.
constexpr std::size_t min_entries = 4, max_entries = 20;
/// That a plan is waited for.
constexpr int max_frames = 1000;
/// One frame at 60 Hz.
constexpr double frame_ms = 1000.0 / 60;

/// CPU time of the calling thread: the Composer's own thread compiles beside it.
double thread_ms() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

/// Adds, removes, moves or copies; errors are those of an entry that cannot go there.
Result<> restructure(std::mt19937& random, Look& look) {
    using edit::test::below;
    const std::vector<std::string> names = entry_names(look);
    const std::string& entry = names[below(random, names.size())];
    const std::string& other = names[below(random, names.size())];
    const std::uint32_t kind = below(random, 4);
    if (kind == 0) return edit::move_entry(look, entry, other);
    if (names.size() >= max_entries || (kind == 1 && names.size() > min_entries))
        return edit::remove_entry(look, entry);
    const Result<std::string> made = kind == 2
                                         ? edit::duplicate_entry(look, entry)
                                         : edit::add_effect(look, *all_effects()[below(random, all_effects().size())]);
    return made ? Result<>() : failure(made.error());
}

/// What is refused is an edit, too: it takes its time.
void edit_once(std::mt19937& random, edit::LookDocument& document) {
    switch (edit::test::below(random, 8)) {
        case 0:
            return document.undo();
        case 1:
            return document.redo();
        case 2:
        case 3:
        case 4:
            (void)document.edit("stack", [&](Look& look) { return restructure(random, look); });
            return;
        default:
            (void)document.edit("value", [&](Look& look) {
                edit::test::RandomEdit made = edit::test::random_value_edit(random, look);
                // The picture keeps the target's size.
                while (made.row == "scale") made = edit::test::random_value_edit(random, look);
                return edit::test::apply_edit(look, made);
            });
    }
}

struct FrameTimes {
    std::vector<double> own, steady, after_a_plan;  ///< milliseconds
    std::uint32_t plans = 0, refused = 0;
};

struct Session {
    Bed& bed;
    Composer& composer;
    Submitter& submitter;
    edit::LookDocument document;
    Look shown;
    CompileDesc desc;
    std::uint64_t version = 0;

    Result<> follow() {
        if (version == document.version()) return {};
        version = document.version();
        DARKROOM_TRY_VALUE(const Followed followed,
                           darkroom::follow(shown, document.look(), composer, {.keeps_what_is_off = true}));
        shown = document.look();
        return followed.needs_compile ? composer.compile_later(desc) : Result<>();
    }
};

/// `random`: null for a frame without an edit.
Result<> show_frame(Session& session, std::mt19937* random, FrameTimes& times) {
    const double begin = thread_ms();
    if (random != nullptr) edit_once(*random, session.document);
    if (!session.follow()) ++times.refused;
    double own = thread_ms() - begin;
    const bool had_pending = session.composer.pending().is_pending;
    const auto sample = session.submitter.run([&](VkCommandBuffer commands) {
        const double recording = thread_ms();
        // A picture of another size, by an entry's scale, does not fit the target: a frame without one.
        if (!session.composer.record(commands, session.bed.frame(WorldUse::Full))) ++times.refused;
        own += thread_ms() - recording;
        return Result<>();
    });
    if (!sample) return failure(sample.error());
    const bool is_new = had_pending && !session.composer.pending().is_pending;
    times.own.push_back(own);
    (is_new ? times.after_a_plan : times.steady).push_back(sample->wall_ms);
    times.plans += is_new ? 1 : 0;
    return {};
}

double most(const std::vector<double>& values) { return values.empty() ? 0 : *std::ranges::max_element(values); }

}  // namespace

Result<std::vector<Figure>> edit_figures(Device& device, std::uint32_t edits) {
    DARKROOM_TRY_VALUE(const auto bed, Bed::create(device, edited_extent));
    DARKROOM_TRY(bed->make_world());
    DARKROOM_TRY_VALUE(
        Look look,
        parse_look("[post_process]\norder = \"documented\"\nvignette_enabled = true\ndither_enabled = true\n",
                   "documented.toml"));
    Composer composer(device, {.frames_in_flight = 1});
    DARKROOM_TRY(apply(look, composer, {.keeps_what_is_off = true}));
    const CompileDesc desc = bed->compile_desc(WorldUse::Full);
    DARKROOM_TRY(composer.compile(desc));
    DARKROOM_TRY_VALUE(const auto submitter, Submitter::create(device.context()));
    Session session{*bed, composer, *submitter, edit::LookDocument(look), look, desc};
    session.version = session.document.version();
    std::mt19937 random(29);
    FrameTimes times;
    for (std::uint32_t i = 0; i < edits; ++i) {
        Result<> shown = show_frame(session, &random, times);
        // Every other edit comes while the plan of the one before is still being made.
        for (int frame = 0; shown && i % 2 != 0 && frame < max_frames && composer.pending().is_pending; ++frame)
            shown = show_frame(session, nullptr, times);
        if (!shown) return failure(std::move(shown));
    }
    return std::vector<Figure>{
        {fmt::format("{}: CPU time of our calls in a frame, median", edits_name), median(times.own), "ms"},
        {fmt::format("{}: the same, worst", edits_name), most(times.own), "ms", frame_ms},
        {fmt::format("{}: plans taken", edits_name), static_cast<double>(times.plans), ""},
        {fmt::format("{}: frames without a picture, of looks that cannot be", edits_name),
         static_cast<double>(times.refused), ""},
        {fmt::format("{}: frame, submit to fence: median", edits_name), median(times.steady), "ms"},
        {fmt::format("{}: frame, submit to fence: worst", edits_name), most(times.steady), "ms"},
        {fmt::format("{}: first frame of a plan, submit to fence: median", edits_name), median(times.after_a_plan),
         "ms"},
        {fmt::format("{}: first frame of a plan, submit to fence: worst", edits_name), most(times.after_a_plan), "ms"},
    };
}

}  // namespace darkroom::bench
