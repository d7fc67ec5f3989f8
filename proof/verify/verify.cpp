// SPDX-License-Identifier: MIT
#include "verify/verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <random>
#include <tuple>

#include "gpu/device/context.hpp"
#include "gpu/kernel/kernel_store.hpp"
#include "verify/runner.hpp"

namespace darkroom::verify {

namespace {

// The least that still shows a finding: what someone who has to read a driver's compiler wants to start from.

/// Does this subject, in this form, make another picture than the reference?
using Shows = std::function<bool(const Subject&, const Form&)>;

class Search {
  public:
    Search(Finding& finding, const Shows& shows, std::size_t tries)
        : finding_(finding), shows_(shows), tries_(tries), form_(finding.form) {
        finding_.smallest = finding.subject;
        finding_.smallest_extent = finding.form.extent;
    }

    void run() {
        drop_steps();
        take_back_values();
        halve_sides();
    }

  private:
    [[nodiscard]] bool still_shows(const Subject& subject, VkExtent2D extent) {
        if (tries_ == 0) return false;
        --tries_;
        form_.extent = extent;
        return shows_(subject, form_);
    }
    [[nodiscard]] bool keep_if_it_shows(Subject subject) {
        if (!still_shows(subject, finding_.smallest_extent)) return false;
        finding_.smallest = std::move(subject);
        return true;
    }

    void drop_steps() {
        for (std::size_t i = finding_.smallest.steps.size(); i-- > 0 && finding_.smallest.steps.size() > 1;) {
            Subject fewer = finding_.smallest;
            fewer.steps.erase(fewer.steps.begin() + static_cast<std::ptrdiff_t>(i));
            static_cast<void>(keep_if_it_shows(std::move(fewer)));
        }
    }

    void take_back_values() {
        for (std::size_t i = 0; i < finding_.smallest.steps.size(); ++i)
            for (const ParamInfo& row : finding_.smallest.steps[i].info->parameters.rows) {
                Subject plainer = finding_.smallest;
                Step& step = plainer.steps[i];
                const auto defaults = step.info->parameters.defaults.subspan(row.word, row.words);
                const auto present = std::span(step.words).subspan(row.word, row.words);
                if (std::ranges::equal(defaults, present)) continue;
                std::ranges::copy(defaults, present.begin());
                const bool is_wrong = step.info->conflict != nullptr && !step.info->conflict(step.words.data()).empty();
                if (!is_wrong && is_seen(*step.info, step.words))
                    static_cast<void>(keep_if_it_shows(std::move(plainer)));
            }
    }

    void halve_sides() {
        for (const bool is_width : {true, false})
            while (true) {
                VkExtent2D extent = finding_.smallest_extent;
                std::uint32_t& side = is_width ? extent.width : extent.height;
                if (side == 1) break;
                side /= 2;
                if (!still_shows(finding_.smallest, extent)) break;
                finding_.smallest_extent = extent;
            }
    }

    Finding& finding_;
    const Shows& shows_;
    std::size_t tries_;
    Form form_;
};

/// Sets `smallest` and `smallest_extent`: drops steps, takes values back to defaults, halves the picture's sides, each
/// for as long as `shows` says yes, which is asked at most `max_tries` times.
void make_smaller(Finding& finding, const Shows& shows, std::size_t max_tries = 64) {
    Search(finding, shows, max_tries).run();
}

/// How many subjects are recorded into one command buffer, in another order than they were tried in.
constexpr std::size_t together = 8;

/// The most that effects say of curves of theirs (effects/shared/srgb.glsl and those that include it): so much of an
/// encoded value.
constexpr double curve_step = 5.3e-5;

/// How a picture differs from one that must have the same bits.
Difference bits_apart(const ReferenceImage& made, const ReferenceImage& before) {
    return difference(made, {before, ReferenceImage(before.width, before.height, {0, 0, 0, 0})});
}

/// Some drivers round a filtered fetch of 8 bits to 8 bits, up to three of which an effect mixes.
constexpr double table_step = 1.5 / 255;

double larger_side(const DeviceScene& scene) {
    const VkExtent2D extent = scene.frames().back().extent();
    return std::max(extent.width, extent.height);
}

bool is_same_number(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }
bool has_same_bits(const ReferenceImage& a, const ReferenceImage& b) {
    return std::ranges::equal(a.pixels, b.pixels, [](const Rgba& p, const Rgba& q) {
        return is_same_number(p.r, q.r) && is_same_number(p.g, q.g) && is_same_number(p.b, q.b) &&
               is_same_number(p.a, q.a);
    });
}

class Verifying {
  public:
    Verifying(Device& device, const Options& options, const Listener& listener)
        : device_(device), context_(device.context()), options_(options), listener_(listener) {}

    Result<Report> run() {
        report_.device = device_.info();
        report_.seed = options_.subjects.seed;
        note_traits();
        const std::uint64_t built = context_.kernels->counters().built;
        const std::vector<Subject> all = subjects(options_.subjects);
        // A chain takes as long as all effects one by one: the first size is enough.
        const auto is_usual = [](const Subject& subject) { return find_effect(subject.name) != nullptr; };
        const auto usual = static_cast<std::size_t>(std::ranges::count_if(all, is_usual));
        total_ = all.size() + usual * (options_.sizes.size() - std::min<std::size_t>(options_.sizes.size(), 1));
        for (std::size_t i = 0; i < options_.sizes.size(); ++i) {
            for (const Subject& subject : all)
                if (i == 0 || is_usual(subject)) DARKROOM_TRY(try_subject(subject, options_.sizes[i]));
            DARKROOM_TRY(try_together());
        }
        report_.kernels = context_.kernels->counters().built - built;
        report_.seconds = seconds();
        return std::move(report_);
    }

  private:
    /// What was tried and may be tried again beside others.
    struct Tried {
        std::unique_ptr<Runner> runner;
        Subject subject;
        Form form;
        ReferenceImage picture;
    };

    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }
    [[nodiscard]] bool is_late() const { return options_.seconds > 0 && seconds() > options_.seconds; }

    void note_traits() {
        const gpu::Traits& traits = context_.traits;
        const auto flag = [&](const char* name, bool value) {
            report_.traits.emplace_back(name, value ? "yes" : "no");
        };
        const auto number = [&](const char* name, std::uint64_t value) {
            report_.traits.emplace_back(name, std::to_string(value));
        };
        flag("graphics queue", traits.has_graphics);
        flag("shaderStorageImageExtendedFormats", traits.has_extended_storage_formats);
        flag("shaderStorageImageWriteWithoutFormat", traits.has_storage_write_without_format);
        flag("robustImageAccess", traits.has_robust_images);
        number("maxImageDimension2D", traits.max_image_dimension);
        number("maxUniformBufferRange", traits.max_uniform_range);
        number("maxComputeWorkGroupInvocations", traits.max_workgroup_invocations);
        number("maxComputeSharedMemorySize", traits.max_shared_bytes);
        number("maxPerStageDescriptorStorageImages", traits.max_storage_images);
        number("maxPerStageDescriptorSampledImages", traits.max_sampled_images);
        number("subTexelPrecisionBits", traits.sub_texel_bits);
    }

    Result<const DeviceScene*> scene_of(const Subject& subject, VkExtent2D extent) {
        const bool is_larger = makes_output(subject);
        std::unique_ptr<DeviceScene>& scene = scenes_[{extent.width, extent.height, is_larger}];
        if (scene == nullptr) {
            const VkExtent2D larger{extent.width * 3 / 2, extent.height * 3 / 2};
            DARKROOM_TRY_VALUE(scene, DeviceScene::create(device_, extent, is_larger ? larger : VkExtent2D{}));
        }
        return scene.get();
    }

    /// What must be, and how many moved frames have been tried for it.
    struct Expected {
        Expectation all;
        std::size_t moved = few_moved;
    };

    [[nodiscard]] Result<Expectation> expectation_of(const Subject& subject, const Runner& runner,
                                                     const DeviceScene& scene, std::size_t moved) const {
        Precision precision = runner.precision();
        if (filters_byte_tables(subject)) precision.table_step = table_step;
        if (has_curves(subject)) precision.curve_step = curve_step;
        // Grids of vertices hold shifts in images, of a quarter of the picture at most where values are usual ones.
        if (is_map(subject)) precision.place_step = precision.image_step * larger_side(scene) / 4;
        if (filters(subject))
            precision.filter_step = std::ldexp(1.0, -static_cast<int>(context_.traits.sub_texel_bits));
        return expect(subject, std::span(scene.frames()).subspan(runner.first_frame()), precision, moved);
    }

    Result<> try_subject(const Subject& subject, VkExtent2D extent) {
        if (listener_.begins) listener_.begins(subject.name, done_, total_);
        ++done_;
        DARKROOM_TRY_VALUE(const DeviceScene* const scene, scene_of(subject, extent));
        std::optional<Expected> expected;
        for (const KernelStage stage : {KernelStage::Compute, KernelStage::Raster}) {
            const Form form{.stage = stage, .is_lean = false, .extent = extent};
            if (stage == KernelStage::Raster && !context_.traits.has_graphics) continue;
            if (is_late()) {
                report_.not_tried.push_back(fmt::format("{}, {}", subject.name, text_of(form)));
                continue;
            }
            Result<> done = try_stage(subject, *scene, form, expected);
            if (done) continue;
            if (done.error().code == ErrorCode::DeviceLost) return done;
            // Values that do not go together are no fault of a device.
            if (done.error().fault == Fault::User) {
                report_.not_tried.push_back(fmt::format("{}, {}: {}", subject.name, text_of(form), done.error().text));
                continue;
            }
            note({.kind = Finding::Kind::Failed, .subject = subject, .form = form, .error = done.error().text});
        }
        return tried_.size() < together ? Result<>() : try_together();
    }

    Result<> try_stage(const Subject& subject, const DeviceScene& scene, Form form, std::optional<Expected>& expected) {
        DARKROOM_TRY_VALUE(std::unique_ptr<Runner> made, Runner::create(device_, subject, scene, form.stage));
        Runner& runner = *made;
        if (!expected) {
            DARKROOM_TRY_VALUE(Expectation all, expectation_of(subject, runner, scene, few_moved));
            expected = Expected{std::move(all)};
            if (has_same_bits(expected->all.picture, scene.frames().back().color()))
                report_.unchanged.push_back(
                    fmt::format("{}, {}x{}", subject.name, form.extent.width, form.extent.height));
        }
        ReferenceImage lean;
        for (form.is_lean = false;; form.is_lean = true) {
            if (form.is_lean) runner.make_lean();
            DARKROOM_TRY_VALUE(ReferenceImage picture, runner.run());
            ++report_.pictures;
            DARKROOM_TRY(judge(runner, subject, scene, form, picture, *expected));
            lean = std::move(picture);
            if (form.is_lean) break;
        }
        DARKROOM_TRY_VALUE(const ReferenceImage again, runner.run());
        compare_bits(Finding::Kind::Repeat, runner, subject, form, again, lean);
        tried_.push_back({std::move(made), subject, form, std::move(lean)});
        return {};
    }

    /// All that were tried since, recorded into one command buffer in another order.
    Result<> try_together() {
        std::ranges::shuffle(tried_, random_);
        for (std::size_t number = 0; number < frame_count; ++number) {
            Result<> recorded{};
            const Result<> done =
                gpu::submit_and_wait(context_, "verifying several kernels", [&](VkCommandBuffer commands) {
                    for (const Tried& one : tried_)
                        if (recorded && number >= one.runner->first_frame())
                            recorded = one.runner->record(commands, number);
                });
            if (!recorded) return failure(recorded.error());
            if (!done) return failure(done.error());
        }
        for (const Tried& one : tried_)
            compare_bits(Finding::Kind::Order, *one.runner, one.subject, one.form, one.runner->read(), one.picture);
        tried_.clear();
        return {};
    }

    Result<> judge(const Runner& runner, const Subject& subject, const DeviceScene& scene, const Form& form,
                   const ReferenceImage& picture, Expected& expected) {
        Difference worst = difference(picture, expected.all);
        if (worst.pixels > 0 && expected.moved < many_moved) {
            DARKROOM_TRY_VALUE(Expectation all, expectation_of(subject, runner, scene, many_moved));
            expected = {std::move(all), many_moved};
            worst = difference(picture, expected.all);
        }
        if (worst.pixels == 0) return {};
        note({.kind = Finding::Kind::Reference,
              .subject = subject,
              .form = form,
              .kernels = kernels_of(runner),
              .worst = worst,
              .made = picture,
              .expected = expected.all.picture});
        return {};
    }

    void compare_bits(Finding::Kind kind, const Runner& runner, const Subject& subject, const Form& form,
                      const ReferenceImage& picture, const ReferenceImage& before) {
        if (has_same_bits(picture, before)) return;
        note({.kind = kind,
              .subject = subject,
              .form = form,
              .kernels = kernels_of(runner),
              .worst = bits_apart(picture, before),
              .made = picture,
              .expected = before});
    }

    static std::vector<std::string> kernels_of(const Runner& runner) {
        std::vector<std::string> out;
        for (const PlanPass& pass : runner.plan().passes) out.push_back(pass.name);
        return out;
    }

    [[nodiscard]] bool shows(const Subject& subject, const Form& form) {
        const Result<const DeviceScene*> scene = scene_of(subject, form.extent);
        if (!scene) return false;
        const Result<std::unique_ptr<Runner>> runner = Runner::create(device_, subject, **scene, form.stage);
        if (!runner) return false;
        Result<ReferenceImage> picture = (*runner)->run();
        if (picture && form.is_lean) {
            (*runner)->make_lean();
            picture = (*runner)->run();
        }
        if (!picture) return false;
        for (const std::size_t moved : {few_moved, many_moved}) {
            const Result<Expectation> expectation = expectation_of(subject, **runner, **scene, moved);
            if (!expectation || difference(*picture, *expectation).pixels == 0) return false;
        }
        return true;
    }

    void note(Finding finding) {
        if (finding.kind == Finding::Kind::Reference && options_.makes_smaller && !is_late())
            make_smaller(finding,
                         [&](const Subject& subject, const Form& form) { return !is_late() && shows(subject, form); });
        if (listener_.found) listener_.found(finding);
        report_.findings.push_back(std::move(finding));
    }

    Device& device_;
    gpu::Context& context_;
    const Options& options_;
    const Listener& listener_;
    Report report_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::map<std::tuple<std::uint32_t, std::uint32_t, bool>, std::unique_ptr<DeviceScene>> scenes_;
    std::vector<Tried> tried_;  // behind the scenes that they read
    std::mt19937 random_{1};
    std::size_t done_ = 0, total_ = 0;
};

}  // namespace

std::string text_of(const Form& form) {
    return fmt::format("{}, {}, {}x{}", form.stage == KernelStage::Compute ? "compute" : "raster",
                       form.is_lean ? "lean" : "complete", form.extent.width, form.extent.height);
}

std::string_view name_of(Finding::Kind kind) {
    constexpr std::array<std::string_view, 4> names{"reference", "repeat", "order", "failed"};
    return names[static_cast<std::size_t>(kind)];
}

std::string text_of(const Finding& finding) {
    constexpr std::array channel_names{"red", "green", "blue", "alpha"};
    const Difference& worst = finding.worst;
    const std::string what = fmt::format("{}, {}: ", finding.subject.name, text_of(finding.form));
    if (finding.kind == Finding::Kind::Failed) return what + finding.error;
    const std::string pixel =
        fmt::format("pixel ({}, {}), {}: {:.7g}", worst.x, worst.y, channel_names[worst.channel], worst.value);
    const std::string others = fmt::format("{} of {} pixels", worst.pixels, finding.made.pixels.size());
    if (finding.kind == Finding::Kind::Reference)
        return fmt::format("{}{}, the reference says {:.7g} and allows {:.2g}; {}", what, pixel, worst.expected,
                           worst.allowed, others);
    return fmt::format("{}{}, was {:.7g} before {}; {}", what, pixel, worst.expected,
                       finding.kind == Finding::Kind::Repeat ? "it was repeated" : "it ran beside others", others);
}

Result<Report> run(Device& device, const Options& options, const Listener& listener) {
    if (device.context().queue == VK_NULL_HANDLE)
        return user_error("verify: the device is a host's, or an assumed one; it takes one that the library created");
    return Verifying(device, options, listener).run();
}

}  // namespace darkroom::verify
