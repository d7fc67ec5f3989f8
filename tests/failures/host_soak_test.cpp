// SPDX-License-Identifier: MIT
// A host that runs for hours: looks, values, toggles and sizes change at random, devices are lost, and a still picture
// comes out as it did at first. What the library holds is counted: bytes of its own, Vulkan objects, device memory.
#include <malloc.h>

#include <chrono>
#include <cstdlib>
#include <darkroom/look.hpp>
#include <random>

#include "compose/test_stacks/host.hpp"
#include "core/test_support_allocations.hpp"
#include "gpu/test_failing/attempts.hpp"

namespace darkroom {
namespace {

using gpu::test::Attempt;
using test::Host;
namespace failing = gpu::test::failing;

/// A picture is compared, and all is counted, after so many frames.
constexpr std::uint64_t frames_between = 2000;
/// Five bytes a frame, left behind in each, are more.
constexpr std::int64_t max_growth = 64 << 10;

constexpr std::array look_texts{
    "[post_process]\nexposure = 1.2\nbloom_enabled = true\nbloom_intensity = 0.2\nvignette_intensity = 0.4\n",
    "[post_process]\nexposure = 0.7\nfilm_grain_intensity = 0.1\nsharpen_strength = 0.5\n",
    "[post_process]\norder = \"scene_linear\"\nexposure = 1.5\nchromatic_aberration_strength = 0.3\n",
    "[[stack]]\neffect = \"gaussian_blur\"\n[[stack]]\neffect = \"vignette\"\n[[stack]]\neffect = \"encode\"\n"
    "[[stack]]\neffect = \"dither\"\n"};

/// What is held at a checkpoint.
struct Held {
    std::int64_t own_bytes = 0;
    std::size_t objects = 0;
    std::uint64_t device_bytes = 0;
};

class HostRun {
  public:
    explicit HostRun(bool is_validated)
        : plain_(make(is_validated)), hosts_{host_of(40, 24, 7), host_of(61, 33, 8), host_of(33, 47, 9)} {
        for (const char* const text : look_texts) looks_.push_back(test::must(parse_look(text, "a look")));
        renew();
    }

    /// Frames as a host makes them, with whatever comes in between.
    void run(std::uint64_t frames) {
        for (std::uint64_t i = 0; i < frames; ++i) {
            if (one_in(40)) set_any();
            if (one_in(60)) toggle_any();
            if (one_in(200)) recompile();
            if (one_in(400)) change_look();
            if (one_in(1500)) lose_device();
            const Host& host = *hosts_[at_];
            Frame frame = host.frame();
            frame.time = static_cast<double>(shown_) / 60;
            frame.frame_index = shown_++;
            test::must(host.record(*composer_, frame));
        }
    }
    /// Of a picture that never changes.
    [[nodiscard]] ReferenceImage still() {
        renew();
        return hosts_[0]->run(*composer_);
    }
    [[nodiscard]] Held held() const { return {test::live_bytes(), failing::alive().size(), failing::memory_bytes()}; }
    [[nodiscard]] std::uint64_t messages() const { return plain_.validation_messages(); }

  private:
    static Device make(bool is_validated) {
        const char* const was = std::getenv("DARKROOM_VALIDATE");
        const std::string before = was == nullptr ? "" : was;
        ::setenv("DARKROOM_VALIDATE", is_validated ? "1" : "0", 1);
        Device device = test::must(Device::create({.cache_folder = ::testing::TempDir() + "darkroom_test_cache"}));
        ::setenv("DARKROOM_VALIDATE", before.c_str(), 1);
        return device;
    }
    std::unique_ptr<Host> host_of(std::uint32_t width, std::uint32_t height, std::uint32_t number) {
        return std::make_unique<Host>(test::round_to_float(test::random_display(width, height, number)),
                                      VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT, plain_);
    }
    /// Another device, and a Composer that begins again.
    void renew() {
        composer_.reset();
        device_.reset();
        device_.emplace(test::must(attempt_.adopted(plain_)));
        composer_.emplace(*device_, ComposerDesc{.max_threads = 0});
        at_ = 0;
        test::must(apply(looks_[0], *composer_));
        test::must(composer_->compile(hosts_[0]->compile_desc()));
    }
    void lose_device() {
        Device other = test::must(attempt_.adopted(plain_));
        test::must(composer_->rebind(other));
        device_.emplace(std::move(other));
    }
    void recompile() {
        at_ = random(hosts_.size());
        if (one_in(2))
            test::must(composer_->compile(hosts_[at_]->compile_desc()));
        else
            test::must(composer_->compile_later(hosts_[at_]->compile_desc()));
    }
    void change_look() {
        composer_->clear();
        test::must(apply(looks_[random(looks_.size())], *composer_));
        recompile();
    }
    void set_any() {
        if (composer_->size() == 0) return;
        const Handle entry = composer_->entry(random(composer_->size()));
        const std::span<const ParamInfo> rows = composer_->info(entry)->parameters.rows;
        if (rows.empty()) return;
        const ParamInfo& row = rows[random(rows.size())];
        if (row.kind != Kind::Float) return;
        const std::uint32_t before = composer_->words(entry)[row.word];
        const double most = std::min(row.range.max, row.range.min + 1);
        static_cast<void>(
            composer_->set(entry, row.name, std::uniform_real_distribution(row.range.min, most)(random_)));
        // Some values do not go together.
        const auto conflict = composer_->info(entry)->conflict;
        if (conflict != nullptr && !conflict(composer_->words(entry).data()).empty())
            test::set_word(*composer_, entry, row.name, before);
    }
    void toggle_any() {
        if (composer_->size() == 0) return;
        test::must(composer_->set_enabled(composer_->entry(random(composer_->size())), one_in(2)));
    }
    [[nodiscard]] std::size_t random(std::size_t count) {
        return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_);
    }
    [[nodiscard]] bool one_in(std::size_t count) { return random(count) == 0; }

    Device plain_;
    std::array<std::unique_ptr<Host>, 3> hosts_;
    std::vector<Look> looks_;
    Attempt attempt_;
    std::optional<Device> device_;
    std::optional<Composer> composer_;
    std::size_t at_ = 0;
    std::uint64_t shown_ = 0;
    std::mt19937 random_{11};
};

/// Frames of the long run; a shorter one says so by a variable.
std::uint64_t frames_wanted(std::uint64_t usual) {
    const char* const variable = std::getenv("DARKROOM_SOAK_FRAMES");
    return variable == nullptr ? usual : std::strtoull(variable, nullptr, 10);
}

class SoakHost : public test::StackTest {
  protected:
    static void run(bool is_validated, std::uint64_t frames) {
        const auto start = std::chrono::steady_clock::now();
        HostRun host(is_validated);
        const ReferenceImage first = host.still();
        std::optional<Held> before;
        for (std::uint64_t done = 0; done < frames && !HasFailure(); done += frames_between) {
            host.run(frames_between);
            EXPECT_EQ(test::worst_difference(host.still(), first), 0) << "a still picture has changed";
            const Held now = host.held();
            const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            fmt::print("frame {}: {} bytes its own, {} objects, {} bytes of the device, {} KiB of malloc, {:.0f} s\n",
                       done + frames_between, now.own_bytes, now.objects, now.device_bytes,
                       ::mallinfo2().uordblks / 1024, seconds);
            std::fflush(stdout);
            if (!before) before = now;
            EXPECT_EQ(now.objects, before->objects);
            EXPECT_EQ(now.device_bytes, before->device_bytes);
            // The layer gives back outside of calls what it got in them.
            if (!is_validated) {
                EXPECT_LE(now.own_bytes - before->own_bytes, max_growth);
            }
        }
        EXPECT_EQ(host.messages(), 0U);
    }
};

TEST_F(SoakHost, LeavesNothingBehindInManyFrames) {
    if (!test::counts_allocations()) GTEST_SKIP() << "this build has its own operator new";
    run(false, frames_wanted(300'000));
}
TEST_F(SoakHost, SaysNothingInManyFrames) { run(true, frames_wanted(10'000)); }

}  // namespace
}  // namespace darkroom
