// SPDX-License-Identifier: MIT
// What a driver may answer while frames are shown: each answer is put in its place, behind the real one where that has
// to happen, in a real window.
#include "window/presenter.hpp"

#include <deque>

#include "gpu/device/context.hpp"
#include "viewer_support.hpp"
#include "window/window.hpp"

namespace darkroom::test {

namespace {

struct Driver {
    PFN_vkGetDeviceProcAddr get_proc = nullptr;
    PFN_vkAcquireNextImageKHR acquire = nullptr;
    PFN_vkQueuePresentKHR present = nullptr;
    PFN_vkCreateSwapchainKHR create = nullptr;
    PFN_vkDestroySwapchainKHR destroy = nullptr;
};
Driver driver;
std::deque<VkResult> to_acquire, to_present;  ///< what is answered next, once each
int swapchains = 0, max_swapchains = 0;       ///< there now, at once

VkResult acquire(VkDevice device, VkSwapchainKHR swapchain, std::uint64_t timeout, VkSemaphore semaphore, VkFence fence,
                 std::uint32_t* image) {
    const VkResult answer = to_acquire.empty() ? VK_SUCCESS : to_acquire.front();
    if (!to_acquire.empty()) to_acquire.pop_front();
    if (answer < 0) return answer;
    const VkResult real = driver.acquire(device, swapchain, timeout, semaphore, fence, image);
    return real == VK_SUCCESS ? answer : real;
}

VkResult present(VkQueue queue, const VkPresentInfoKHR* info) {
    const VkResult real = driver.present(queue, info);
    if (to_present.empty()) return real;
    const VkResult answer = to_present.front();
    to_present.pop_front();
    return answer;
}

VkResult create(VkDevice device, const VkSwapchainCreateInfoKHR* info, const VkAllocationCallbacks* allocator,
                VkSwapchainKHR* out) {
    const VkResult result = driver.create(device, info, allocator, out);
    if (result == VK_SUCCESS) max_swapchains = std::max(max_swapchains, ++swapchains);
    return result;
}

void destroy(VkDevice device, VkSwapchainKHR swapchain, const VkAllocationCallbacks* allocator) {
    --swapchains;
    driver.destroy(device, swapchain, allocator);
}

PFN_vkVoidFunction get_proc(VkDevice device, const char* name) {
    const PFN_vkVoidFunction real = driver.get_proc(device, name);
    const auto put = [&](auto& kept, auto* own) {
        kept = reinterpret_cast<std::remove_reference_t<decltype(kept)>>(real);
        return reinterpret_cast<PFN_vkVoidFunction>(own);
    };
    const std::string_view wanted(name);
    if (wanted == "vkAcquireNextImageKHR") return put(driver.acquire, acquire);
    if (wanted == "vkQueuePresentKHR") return put(driver.present, present);
    if (wanted == "vkCreateSwapchainKHR") return put(driver.create, create);
    if (wanted == "vkDestroySwapchainKHR") return put(driver.destroy, destroy);
    return real;
}

class CliPresenter : public ViewerFixture {
  protected:
    void SetUp() override {
        ViewerFixture::SetUp();
        if (IsSkipped() || HasFatalFailure()) return;
        to_acquire.clear();
        to_present.clear();
        swapchains = max_swapchains = 0;
        Result<window::Window> opened = window::Window::create({.title = "a test", .size = {96, 64}});
        ASSERT_TRUE(opened) << opened.error().text;
        window_.emplace(std::move(*opened));
        constexpr std::array extensions{window::Presenter::device_extension};
        Result<Device> made =
            Device::create({.validate = true,
                            .log = [this](Severity, std::string_view line) { log_ += std::string(line) + '\n'; },
                            .instance_extensions = window_->instance_extensions(),
                            .device_extensions = extensions});
        ASSERT_TRUE(made) << made.error().text;
        device_.emplace(std::move(*made));
        driver.get_proc = std::exchange(device_->context().vk.GetDeviceProcAddr, get_proc);
        // At once: what waits for a display is no part of these tests.
        Result<window::Presenter> presenter =
            window::Presenter::create(*device_, {.presentation = window::Presentation::Immediate,
                                                 .make_surface = [this](VkInstance instance) -> Result<VkSurfaceKHR> {
                                                     if (std::exchange(has_no_surface_, false))
                                                         return machine_error("there is no surface");
                                                     return window_->make_surface(instance);
                                                 }});
        ASSERT_TRUE(presenter) << presenter.error().text;
        presenter_.emplace(std::move(*presenter));
        show(4);
    }
    void TearDown() override {
        presenter_.reset();
        EXPECT_EQ(swapchains, 0);
        if (device_) {
            EXPECT_EQ(device_->validation_messages(), 0U);
        }
        device_.reset();
        EXPECT_EQ(log_, "");
        window_.reset();
        ViewerFixture::TearDown();
    }
    /// One turn: was a frame shown?
    bool turn() {
        window_->poll();
        const auto frame = presenter_->begin(window_->extent());
        EXPECT_TRUE(frame) << frame.error().text;
        if (!frame || !*frame) return false;
        const Result<> shown = presenter_->end();
        EXPECT_TRUE(shown) << shown.error().text;
        return shown.has_value();
    }
    /// Turns until so many frames were shown, of which every other at least is one.
    void show(int frames) {
        int turns = 0;
        for (int shown = 0; shown < frames && turns < 2 * frames + 2; ++turns) shown += turn() ? 1 : 0;
        EXPECT_LT(turns, 2 * frames + 2) << "frames go on";
    }
    [[nodiscard]] const window::PresenterCounters& counters() const { return presenter_->counters(); }

    std::string log_;
    bool has_no_surface_ = false;  ///< the next that is made cannot be
    std::optional<window::Window> window_;
    std::optional<Device> device_;
    std::optional<window::Presenter> presenter_;
};

TEST_F(CliPresenter, ReplacesWhatIsOutOfDate) {
    for (auto* const at : {&to_acquire, &to_present}) {
        for (const VkResult answer : {VK_ERROR_OUT_OF_DATE_KHR, VK_SUBOPTIMAL_KHR}) {
            const window::PresenterCounters before = counters();
            at->push_back(answer);
            show(8);
            EXPECT_EQ(counters().swapchains, before.swapchains + 1) << answer;
            EXPECT_EQ(counters().surfaces, before.surfaces);
            EXPECT_EQ(counters().retired, 0U) << "the old one is freed when its frames are done";
        }
    }
}

TEST_F(CliPresenter, MakesALostSurfaceAgain) {
    for (auto* const at : {&to_acquire, &to_present}) {
        const window::PresenterCounters before = counters();
        at->push_back(VK_ERROR_SURFACE_LOST_KHR);
        show(8);
        EXPECT_EQ(counters().surfaces, before.surfaces + 1);
        EXPECT_EQ(counters().swapchains, before.swapchains + 1);
        EXPECT_EQ(swapchains, 1);
    }
}

TEST_F(CliPresenter, TriesAgainToMakeALostSurface) {
    to_acquire.push_back(VK_ERROR_SURFACE_LOST_KHR);
    has_no_surface_ = true;
    const auto frame = presenter_->begin(window_->extent());
    ASSERT_FALSE(frame);
    EXPECT_EQ(frame.error().text, "there is no surface");
    show(8);
    EXPECT_EQ(swapchains, 1);
}

TEST_F(CliPresenter, KeepsFewWhereNothingCanBeShownForLong) {
    to_acquire.assign(300, VK_ERROR_OUT_OF_DATE_KHR);
    for (int i = 0; i < 300; ++i) EXPECT_FALSE(turn());
    EXPECT_LT(max_swapchains, 12);
    show(8);
    to_present.assign(300, VK_ERROR_OUT_OF_DATE_KHR);
    show(300);
    EXPECT_LT(max_swapchains, 12);
    show(8);
    EXPECT_EQ(swapchains, 1);
}

}  // namespace

}  // namespace darkroom::test
