// SPDX-License-Identifier: MIT
// A host's use of volk: the loader's functions are there before main, the others once there is an instance.

#include <cstdlib>
#define VOLK_IMPLEMENTATION
#include <volk.h>

namespace {

PFN_vkCreateInstance create_instance = nullptr;

VkResult VKAPI_CALL create_and_load(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* callbacks,
                                    VkInstance* instance) {
    const VkResult result = create_instance(info, callbacks, instance);
    if (result == VK_SUCCESS) volkLoadInstance(*instance);
    return result;
}

[[maybe_unused]] const bool is_loaded = [] {
    if (volkInitialize() != VK_SUCCESS) std::abort();
    create_instance = vkCreateInstance;
    vkCreateInstance = create_and_load;
    return true;
}();

}  // namespace
