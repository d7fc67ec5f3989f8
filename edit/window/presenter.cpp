// SPDX-License-Identifier: MIT
#include "window/presenter.hpp"

#include <vulkan/vulkan.h>

#include <algorithm>
#include <deque>
#include <limits>
#include <mutex>
#include <optional>
#include <type_traits>
#include <vector>

#include "gpu/device/cleared.hpp"
#include "gpu/device/context.hpp"
#include "gpu/resource/barriers.hpp"

namespace darkroom::window {

namespace {

// Vulkan functions of windows, which the library itself does not call.

struct SurfaceFunctions {
    PFN_vkGetPhysicalDeviceSurfaceSupportKHR GetPhysicalDeviceSurfaceSupportKHR = nullptr;
    PFN_vkGetPhysicalDeviceSurfaceCapabilitiesKHR GetPhysicalDeviceSurfaceCapabilitiesKHR = nullptr;
    PFN_vkGetPhysicalDeviceSurfaceFormatsKHR GetPhysicalDeviceSurfaceFormatsKHR = nullptr;
    PFN_vkGetPhysicalDeviceSurfacePresentModesKHR GetPhysicalDeviceSurfacePresentModesKHR = nullptr;
    PFN_vkDestroySurfaceKHR DestroySurfaceKHR = nullptr;
    PFN_vkCreateSwapchainKHR CreateSwapchainKHR = nullptr;
    PFN_vkDestroySwapchainKHR DestroySwapchainKHR = nullptr;
    PFN_vkGetSwapchainImagesKHR GetSwapchainImagesKHR = nullptr;
    PFN_vkAcquireNextImageKHR AcquireNextImageKHR = nullptr;
    PFN_vkQueuePresentKHR QueuePresentKHR = nullptr;
    PFN_vkCreateSemaphore CreateSemaphore = nullptr;
    PFN_vkDestroySemaphore DestroySemaphore = nullptr;
    PFN_vkWaitSemaphores WaitSemaphores = nullptr;
    PFN_vkGetSemaphoreCounterValue GetSemaphoreCounterValue = nullptr;
    PFN_vkSetHdrMetadataEXT SetHdrMetadataEXT = nullptr;  ///< of VK_EXT_hdr_metadata; null: there is none

    /// False: the driver lacks one.
    [[nodiscard]] bool load(const gpu::Context& context);
};

bool SurfaceFunctions::load(const gpu::Context& context) {
    bool is_complete = true;
    const auto of_instance = [&](auto& function, const char* name) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(
            context.vk.GetInstanceProcAddr(context.instance, name));
        is_complete = is_complete && function != nullptr;
    };
    const auto of_device = [&](auto& function, const char* name) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(
            context.vk.GetDeviceProcAddr(context.device, name));
        is_complete = is_complete && function != nullptr;
    };
    of_instance(GetPhysicalDeviceSurfaceSupportKHR, "vkGetPhysicalDeviceSurfaceSupportKHR");
    of_instance(GetPhysicalDeviceSurfaceCapabilitiesKHR, "vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
    of_instance(GetPhysicalDeviceSurfaceFormatsKHR, "vkGetPhysicalDeviceSurfaceFormatsKHR");
    of_instance(GetPhysicalDeviceSurfacePresentModesKHR, "vkGetPhysicalDeviceSurfacePresentModesKHR");
    of_instance(DestroySurfaceKHR, "vkDestroySurfaceKHR");
    of_device(CreateSwapchainKHR, "vkCreateSwapchainKHR");
    of_device(DestroySwapchainKHR, "vkDestroySwapchainKHR");
    of_device(GetSwapchainImagesKHR, "vkGetSwapchainImagesKHR");
    of_device(AcquireNextImageKHR, "vkAcquireNextImageKHR");
    of_device(QueuePresentKHR, "vkQueuePresentKHR");
    of_device(CreateSemaphore, "vkCreateSemaphore");
    of_device(DestroySemaphore, "vkDestroySemaphore");
    of_device(WaitSemaphores, "vkWaitSemaphores");
    of_device(GetSemaphoreCounterValue, "vkGetSemaphoreCounterValue");
    SetHdrMetadataEXT =
        reinterpret_cast<PFN_vkSetHdrMetadataEXT>(context.vk.GetDeviceProcAddr(context.device, "vkSetHdrMetadataEXT"));
    return is_complete;
}

constexpr std::uint64_t forever = std::numeric_limits<std::uint64_t>::max();
/// Swapchains that may wait to be freed. More: the window changes and shows nothing, and the device is waited for.
constexpr std::size_t max_retired = 8;
/// Of one attempt to get an image: a surface that nobody looks at may give none.
constexpr std::uint64_t patience = 100'000'000;  // nanoseconds

VkPresentModeKHR mode_of(Presentation presentation) {
    switch (presentation) {
        case Presentation::Mailbox:
            return VK_PRESENT_MODE_MAILBOX_KHR;
        case Presentation::Immediate:
            return VK_PRESENT_MODE_IMMEDIATE_KHR;
        case Presentation::Vsync:
            break;
    }
    return VK_PRESENT_MODE_FIFO_KHR;
}

template <class T>
VkResult list(std::vector<T>& out, const auto& ask) {
    std::uint32_t count = 0;
    VkResult result = ask(&count, nullptr);
    if (result != VK_SUCCESS) return result;
    out.resize(count);
    result = ask(&count, out.data());
    out.resize(count);
    return result == VK_INCOMPLETE ? VK_SUCCESS : result;
}

struct Swapchain {
    VkSwapchainKHR handle = VK_NULL_HANDLE;
    VkExtent2D extent{};
    struct Image {
        VkImage image = VK_NULL_HANDLE;
        VkImageView view = VK_NULL_HANDLE;
        VkSemaphore is_drawn = VK_NULL_HANDLE;
        std::optional<std::uint64_t> shown;  ///< number of its last frame
    };
    std::vector<Image> images;
};

struct FrameSlot {
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkSemaphore is_acquired = VK_NULL_HANDLE;
};

}  // namespace

struct Presenter::State {
    State(std::shared_ptr<gpu::Context> of, PresenterDesc with) : context(std::move(of)), desc(std::move(with)) {}
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State();

    Result<> create();
    Result<> make_surface();
    Result<> choose_format();
    VkResult make_swapchain(VkExtent2D window);
    VkResult add_images(Swapchain& made);
    void retire();
    void destroy(Swapchain& swapchain);
    void free_retired();
    void wait_idle() const;
    void free_all_retired();
    void drop_frame();
    Result<> replace_surface();
    Result<> wait_for(std::uint64_t finished);
    Result<std::optional<PresentFrame>> begin(VkExtent2D window);
    void change_layout(VkImageLayout from, VkImageLayout to) const;
    Result<> end();
    Result<> check(VkResult result, const char* what) const { return context->check(result, what); }
    VkResult make_semaphore(VkSemaphore& out, const void* chain = nullptr) const {
        const VkSemaphoreCreateInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, .pNext = chain};
        return gpu::cleared_on_failure(vk.CreateSemaphore(context->device, &info, context->allocator, &out), out);
    }

    std::shared_ptr<gpu::Context> context;
    PresenterDesc desc;
    SurfaceFunctions vk;
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    VkSurfaceFormatKHR format{};
    ColorState color = srgb_color;
    bool can_copy = false;
    Swapchain swapchain;
    VkExtent2D asked{};                     ///< for which the swapchain was made
    bool is_stale = true, is_lost = false;  ///< the swapchain, the surface
    struct Retired {
        Swapchain swapchain;
        std::uint64_t last_frame = 0;  ///< that may use it
    };
    std::deque<Retired> retired;
    std::vector<FrameSlot> slots;
    VkSemaphore finished = VK_NULL_HANDLE;  ///< counts the frames that have finished
    std::uint64_t next = 0;                 ///< number of the frame that comes
    PresentFrame frame;
    std::uint32_t image = 0;
    PresenterCounters counters;
};

Presenter::State::~State() {
    if (context->device != VK_NULL_HANDLE && finished != VK_NULL_HANDLE) wait_idle();
    for (Retired& old : retired) destroy(old.swapchain);
    destroy(swapchain);
    for (const FrameSlot& slot : slots) {
        context->vk.DestroyCommandPool(context->device, slot.pool, context->allocator);
        vk.DestroySemaphore(context->device, slot.is_acquired, context->allocator);
    }
    if (finished != VK_NULL_HANDLE) vk.DestroySemaphore(context->device, finished, context->allocator);
    if (surface != VK_NULL_HANDLE) vk.DestroySurfaceKHR(context->instance, surface, nullptr);
}

Result<> Presenter::State::create() {
    if (!vk.load(*context)) return machine_error("the Vulkan driver lacks functions of VK_KHR_swapchain");
    DARKROOM_TRY(make_surface());
    const VkSemaphoreTypeCreateInfo type{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                         .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
    VkResult result = make_semaphore(finished, &type);
    for (std::uint32_t i = 0; i < desc.frames_in_flight && result == VK_SUCCESS; ++i) {
        FrameSlot& slot = slots.emplace_back();
        const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                           .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                           .queueFamilyIndex = context->queue_family};
        result = gpu::cleared_on_failure(
            context->vk.CreateCommandPool(context->device, &pool, context->allocator, &slot.pool), slot.pool);
        if (result != VK_SUCCESS) break;
        const VkCommandBufferAllocateInfo buffer{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                 .commandPool = slot.pool,
                                                 .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                 .commandBufferCount = 1};
        result = context->vk.AllocateCommandBuffers(context->device, &buffer, &slot.commands);
        if (result == VK_SUCCESS) result = make_semaphore(slot.is_acquired);
    }
    return check(result, "preparing the frames of a window");
}

Result<> Presenter::State::make_surface() {
    DARKROOM_TRY_VALUE(surface, desc.make_surface(context->instance));
    ++counters.surfaces;
    VkBool32 is_shown = VK_FALSE;
    const VkResult asked_device =
        vk.GetPhysicalDeviceSurfaceSupportKHR(context->physical_device, context->queue_family, surface, &is_shown);
    DARKROOM_TRY(check(asked_device, "asking what the window shows"));
    if (is_shown == VK_FALSE)
        return machine_error("device \"" + context->info.name + "\" cannot show pictures in this window");
    return choose_format();
}

Result<> Presenter::State::choose_format() {
    std::vector<VkSurfaceFormatKHR> formats;
    const VkResult result = list(formats, [&](std::uint32_t* count, VkSurfaceFormatKHR* to) {
        return vk.GetPhysicalDeviceSurfaceFormatsKHR(context->physical_device, surface, count, to);
    });
    DARKROOM_TRY(check(result, "listing the formats of the window"));
    const std::optional<SurfaceChoice> chosen = choose_surface(formats, desc.range, desc.peak_nits);
    if (!chosen) return machine_error("the window has no format that pictures can be shown in");
    format = chosen->format;
    color = chosen->color;
    return {};
}

VkResult Presenter::State::make_swapchain(VkExtent2D window) {
    VkSurfaceCapabilitiesKHR can{};
    VkResult result = vk.GetPhysicalDeviceSurfaceCapabilitiesKHR(context->physical_device, surface, &can);
    if (result != VK_SUCCESS) return result;
    // A surface without a size of its own takes the window's.
    VkExtent2D extent = can.currentExtent.width == ~0U ? window : can.currentExtent;
    extent.width = std::clamp(extent.width, can.minImageExtent.width, can.maxImageExtent.width);
    extent.height = std::clamp(extent.height, can.minImageExtent.height, can.maxImageExtent.height);
    if (extent.width == 0 || extent.height == 0) return VK_NOT_READY;
    std::vector<VkPresentModeKHR> modes;
    result = list(modes, [&](std::uint32_t* count, VkPresentModeKHR* to) {
        return vk.GetPhysicalDeviceSurfacePresentModesKHR(context->physical_device, surface, count, to);
    });
    if (result != VK_SUCCESS) return result;
    const VkPresentModeKHR wanted = mode_of(desc.presentation);
    const bool has_mode = std::ranges::count(modes, wanted) > 0;
    const std::uint32_t most = can.maxImageCount == 0 ? ~0U : can.maxImageCount;
    can_copy = (can.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_SRC_BIT) != 0;
    const VkCompositeAlphaFlagBitsKHR alpha = (can.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) != 0
                                                  ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                                                  : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    const VkSwapchainCreateInfoKHR info{
        .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
        .surface = surface,
        .minImageCount = std::min(std::max(can.minImageCount, desc.frames_in_flight + 1), most),
        .imageFormat = format.format,
        .imageColorSpace = format.colorSpace,
        .imageExtent = extent,
        .imageArrayLayers = 1,
        .imageUsage = VkImageUsageFlags{VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT} |
                      (can_copy ? VkImageUsageFlags{VK_IMAGE_USAGE_TRANSFER_SRC_BIT} : 0),
        .preTransform = can.currentTransform,
        .compositeAlpha = alpha,
        .presentMode = has_mode ? wanted : VK_PRESENT_MODE_FIFO_KHR,
        .clipped = VK_FALSE,  // what an image had is read again: only what has changed is drawn over it
        .oldSwapchain = swapchain.handle,
    };
    Swapchain made{.extent = extent};
    result = vk.CreateSwapchainKHR(context->device, &info, context->allocator, &made.handle);
    retire();
    if (result != VK_SUCCESS) return result;
    ++counters.swapchains;
    if (vk.SetHdrMetadataEXT != nullptr && !color.is_standard_code()) {
        const VkHdrMetadataEXT told = hdr_metadata(color);
        vk.SetHdrMetadataEXT(context->device, 1, &made.handle, &told);
    }
    result = add_images(made);
    swapchain = std::move(made);
    is_stale = result != VK_SUCCESS;
    asked = window;
    return result;
}

VkResult Presenter::State::add_images(Swapchain& made) {
    std::vector<VkImage> images;
    VkResult result = list(images, [&](std::uint32_t* count, VkImage* to) {
        return vk.GetSwapchainImagesKHR(context->device, made.handle, count, to);
    });
    for (const VkImage handle : images) {
        if (result != VK_SUCCESS) break;
        Swapchain::Image& added = made.images.emplace_back(Swapchain::Image{.image = handle});
        const VkImageViewCreateInfo view{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                         .image = handle,
                                         .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                         .format = format.format,
                                         .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
        result = gpu::cleared_on_failure(
            context->vk.CreateImageView(context->device, &view, context->allocator, &added.view), added.view);
        if (result == VK_SUCCESS) result = make_semaphore(added.is_drawn);
    }
    return result;
}

// Frames that use it are under way, and what they show is read by the window after they have finished: it goes when as
// many frames again have.
void Presenter::State::retire() {
    if (swapchain.handle != VK_NULL_HANDLE) retired.push_back({std::move(swapchain), next + desc.frames_in_flight});
    swapchain = {};
    is_stale = true;
}

void Presenter::State::destroy(Swapchain& of) {
    for (const Swapchain::Image& old : of.images) {
        context->vk.DestroyImageView(context->device, old.view, context->allocator);
        if (old.is_drawn != VK_NULL_HANDLE) vk.DestroySemaphore(context->device, old.is_drawn, context->allocator);
    }
    if (of.handle != VK_NULL_HANDLE) vk.DestroySwapchainKHR(context->device, of.handle, context->allocator);
    of = {};
}

void Presenter::State::free_retired() {
    std::uint64_t done = 0;
    if (vk.GetSemaphoreCounterValue(context->device, finished, &done) != VK_SUCCESS) return;
    while (!retired.empty() && retired.front().last_frame < done) {
        destroy(retired.front().swapchain);
        retired.pop_front();
    }
    if (retired.size() > max_retired) free_all_retired();
    counters.retired = retired.size();
}

// Whatever runs uses what goes next, so a wait that lacks memory is tried once more.
void Presenter::State::wait_idle() const {
    const std::lock_guard lock(context->queue_mutex);
    const VkResult waited = context->vk.DeviceWaitIdle(context->device);
    if (waited != VK_SUCCESS && waited != VK_ERROR_DEVICE_LOST) context->vk.DeviceWaitIdle(context->device);
}

void Presenter::State::free_all_retired() {
    wait_idle();
    for (Retired& old : retired) destroy(old.swapchain);
    retired.clear();
}

// An image was got that is not shown, and nothing waits for the semaphore that came with it: both begin anew.
void Presenter::State::drop_frame() {
    retire();
    free_all_retired();
    vk.DestroySemaphore(context->device, std::exchange(slots[frame.slot].is_acquired, VK_NULL_HANDLE),
                        context->allocator);
}

// Nothing of it may be left before it goes.
Result<> Presenter::State::replace_surface() {
    retire();
    free_all_retired();
    vk.DestroySurfaceKHR(context->instance, std::exchange(surface, VK_NULL_HANDLE), nullptr);
    Result<> made = make_surface();
    is_lost = !made;
    return made;
}

Result<> Presenter::State::wait_for(std::uint64_t count) {
    const VkSemaphoreWaitInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                   .semaphoreCount = 1,
                                   .pSemaphores = &finished,
                                   .pValues = &count};
    return check(vk.WaitSemaphores(context->device, &info, forever), "waiting for a frame");
}

Result<std::optional<PresentFrame>> Presenter::State::begin(VkExtent2D window) {
    if (window.width == 0 || window.height == 0) return std::nullopt;
    // The slot's last frame, and with it all before that one.
    const std::uint64_t in_flight = desc.frames_in_flight;
    if (next >= in_flight) DARKROOM_TRY(wait_for(next - in_flight + 1));
    free_retired();
    const bool is_resized = window.width != asked.width || window.height != asked.height;
    VkResult result = is_lost ? VK_ERROR_SURFACE_LOST_KHR : VK_SUCCESS;
    if (!is_lost && (is_stale || is_resized)) result = make_swapchain(window);
    FrameSlot& slot = slots[next % in_flight];
    if (result == VK_SUCCESS && slot.is_acquired == VK_NULL_HANDLE) result = make_semaphore(slot.is_acquired);
    if (result == VK_SUCCESS)
        result = vk.AcquireNextImageKHR(context->device, swapchain.handle, patience, slot.is_acquired, VK_NULL_HANDLE,
                                        &image);
    switch (result) {
        case VK_SUBOPTIMAL_KHR:
            is_stale = true;
            break;
        case VK_SUCCESS:
            break;
        case VK_ERROR_OUT_OF_DATE_KHR:
            is_stale = true;
            return std::nullopt;
        case VK_NOT_READY:
        case VK_TIMEOUT:
            return std::nullopt;
        case VK_ERROR_SURFACE_LOST_KHR:
            DARKROOM_TRY(replace_surface());
            return std::nullopt;
        default:
            return failure(check(result, "getting a picture of the window"));
    }
    frame = {.number = next,
             .slot = static_cast<std::uint32_t>(next % in_flight),
             .commands = slot.commands,
             .image = swapchain.images[image].image,
             .view = swapchain.images[image].view,
             .extent = swapchain.extent,
             .age = swapchain.images[image].shown ? next - *swapchain.images[image].shown : 0};
    result = context->vk.ResetCommandPool(context->device, slot.pool, 0);
    const VkCommandBufferBeginInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    if (result == VK_SUCCESS) result = context->vk.BeginCommandBuffer(slot.commands, &info);
    if (Result<> done = check(result, "beginning a frame"); !done) {
        drop_frame();
        return failure(std::move(done));
    }
    change_layout(frame.age > 0 ? VK_IMAGE_LAYOUT_PRESENT_SRC_KHR : VK_IMAGE_LAYOUT_UNDEFINED,
                  VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    return frame;
}

void Presenter::State::change_layout(VkImageLayout from, VkImageLayout to) const {
    const bool is_new = to == VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    constexpr VkPipelineStageFlags2 stage = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
    constexpr VkAccessFlags2 read = VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT,
                             write = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
    const VkImageMemoryBarrier2 change = gpu::image_barrier(frame.image, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1},
                                                            {stage, is_new ? VK_ACCESS_2_NONE : write, from},
                                                            {stage, is_new ? read | write : VK_ACCESS_2_NONE, to});
    gpu::record_barriers(context->vk, frame.commands, {&change, 1});
}

Result<> Presenter::State::end() {
    Swapchain::Image& target = swapchain.images[image];
    change_layout(VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
    VkResult result = context->vk.EndCommandBuffer(frame.commands);
    if (Result<> done = check(result, "recording a frame"); !done) {
        drop_frame();
        return done;
    }
    const VkCommandBufferSubmitInfo commands{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                             .commandBuffer = frame.commands};
    const VkSemaphoreSubmitInfo acquired{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                         .semaphore = slots[frame.slot].is_acquired,
                                         .stageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT};
    const std::array<VkSemaphoreSubmitInfo, 2> signals{
        VkSemaphoreSubmitInfo{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                              .semaphore = target.is_drawn,
                              .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT},
        VkSemaphoreSubmitInfo{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                              .semaphore = finished,
                              .value = next + 1,
                              .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT}};
    const VkSubmitInfo2 submit{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                               .waitSemaphoreInfoCount = 1,
                               .pWaitSemaphoreInfos = &acquired,
                               .commandBufferInfoCount = 1,
                               .pCommandBufferInfos = &commands,
                               .signalSemaphoreInfoCount = static_cast<std::uint32_t>(signals.size()),
                               .pSignalSemaphoreInfos = signals.data()};
    const VkPresentInfoKHR present{.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                                   .waitSemaphoreCount = 1,
                                   .pWaitSemaphores = &target.is_drawn,
                                   .swapchainCount = 1,
                                   .pSwapchains = &swapchain.handle,
                                   .pImageIndices = &image};
    std::unique_lock lock(context->queue_mutex);
    result = context->vk.QueueSubmit2(context->queue, 1, &submit, VK_NULL_HANDLE);
    if (Result<> done = check(result, "submitting a frame"); !done) {
        lock.unlock();
        drop_frame();
        return done;
    }
    target.shown = next++;
    result = vk.QueuePresentKHR(context->queue, &present);
    // Nothing may have waited for the semaphore of this image, which goes with its swapchain.
    is_stale = is_stale || result != VK_SUCCESS;
    is_lost = result == VK_ERROR_SURFACE_LOST_KHR;
    const bool is_replaced = is_lost || result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR;
    return is_replaced ? Result<>() : check(result, "showing a frame");
}

Presenter::Presenter(std::unique_ptr<State> state) : state_(std::move(state)) {}
Presenter::Presenter(Presenter&&) noexcept = default;
Presenter& Presenter::operator=(Presenter&&) noexcept = default;
Presenter::~Presenter() = default;

Result<Presenter> Presenter::create(Device& device, PresenterDesc desc) {
    desc.frames_in_flight = std::max(desc.frames_in_flight, 1U);
    auto state = std::make_unique<State>(device.shared_context(), std::move(desc));
    DARKROOM_TRY(state->create());
    return Presenter(std::move(state));
}

Result<std::optional<PresentFrame>> Presenter::begin(VkExtent2D window) { return state_->begin(window); }
Result<> Presenter::end() { return state_->end(); }
Result<> Presenter::wait() { return state_->wait_for(state_->next); }

bool Presenter::is_finished(std::uint64_t number) const {
    std::uint64_t done = 0;
    return state_->vk.GetSemaphoreCounterValue(state_->context->device, state_->finished, &done) == VK_SUCCESS &&
           done > number;
}

const ColorState& Presenter::color() const { return state_->color; }
VkFormat Presenter::format() const { return state_->format.format; }
bool Presenter::can_copy() const { return state_->can_copy; }
const PresenterCounters& Presenter::counters() const { return state_->counters; }

}  // namespace darkroom::window
