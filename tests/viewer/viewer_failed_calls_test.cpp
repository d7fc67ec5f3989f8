// SPDX-License-Identifier: MIT
// Every Vulkan call of frames that are shown in a real window fails once: the window's surface and swapchain are made,
// frames are shown, and it changes its size twice.
#include <fmt/format.h>

#include "gpu/device/context.hpp"
#include "gpu/test_failing/attempts.hpp"
#include "viewer_support.hpp"
#include "window/presenter.hpp"
#include "window/window.hpp"

namespace darkroom::test {

namespace {

using gpu::test::Attempt;

class CliFailedPresenting : public ViewerFixture {
  protected:
    void SetUp() override {
        ViewerFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        Result<window::Window> opened = window::Window::create({.title = "a test", .size = {96, 64}});
        ASSERT_TRUE(opened) << opened.error().text;
        window_.emplace(std::move(*opened));
        constexpr std::array extensions{window::Presenter::device_extension};
        Result<Device> made = Device::create({.validate = true,
                                              .log = [](Severity, std::string_view line) { ADD_FAILURE() << line; },
                                              .instance_extensions = window_->instance_extensions(),
                                              .device_extensions = extensions});
        ASSERT_TRUE(made) << made.error().text;
        plain_.emplace(std::move(*made));
        if (plain_->info().name.find("SwiftShader") != std::string::npos)
            GTEST_SKIP() << "hundreds of this driver's surfaces end the program by an error of X about shared memory";
    }
    void TearDown() override {
        plain_.reset();
        window_.reset();
        ViewerFixture::TearDown();
    }

    /// Tells how many frames were shown.
    std::vector<std::byte> frames(Attempt& attempt) {
        auto device = attempt("adopting", [&] { return attempt.adopted(*plain_); });
        if (!device) return {};
        const window::PresenterDesc desc{
            .presentation = window::Presentation::Immediate,
            .make_surface = [this](VkInstance instance) { return window_->make_surface(instance); }};
        auto presenter = attempt("preparing a window", [&] { return window::Presenter::create(*device, desc); });
        if (!presenter) return {};
        int shown = 0, turns = 0;
        // The presenter makes a swapchain for each size, whatever the window's is.
        for (const VkExtent2D size : {VkExtent2D{96, 64}, VkExtent2D{97, 64}, VkExtent2D{96, 64}})
            for (const int wanted = shown + frames_of_a_size; shown < wanted && turns < max_turns; ++turns) {
                window_->poll();
                const auto begun = presenter->begin(size);
                if (!begun) attempt.expect_told("beginning", begun.error());
                if (!begun || !*begun) continue;
                const Result<> ended = presenter->end();
                if (!ended) attempt.expect_told("ending", ended.error());
                shown += ended ? 1 : 0;
            }
        const Result<> waited = presenter->wait();
        if (!waited) attempt.expect_told("waiting", waited.error());
        return {static_cast<std::byte>(shown)};
    }

    [[nodiscard]] Device& plain() { return *plain_; }

  private:
    static constexpr int frames_of_a_size = 4, max_turns = 60;

    std::optional<window::Window> window_;
    std::optional<Device> plain_;
};

TEST_F(CliFailedPresenting, OfEveryCallOnce) {
    const gpu::test::Points points =
        gpu::test::try_each_call([&](Attempt& attempt) { return frames(attempt); }, ~std::size_t{0}, 1, plain());
    fmt::print("frames of a window: {} calls that may fail, {} points tried\n", points.calls, points.tried);
    EXPECT_GT(points.calls, 100U);
}

}  // namespace

}  // namespace darkroom::test
