// SPDX-License-Identifier: MIT
// How the objects of the C interface are used. docs/c.md quotes it; compiled it is nothing, since nobody calls it.
#include <darkroom/darkroom.h>
#include <stdio.h>

typedef int Report(const char* text);

static inline int usage_stack(VkInstance instance, VkPhysicalDevice gpu, VkDevice vk_device, uint32_t family,
                              VkPhysicalDeviceFeatures2 features, Report* report) {
    DarkroomDevice device = NULL;
    DarkroomComposer composer = NULL;
    DarkroomHandle bloom = 0;
    const DarkroomAdoptDesc adopt = {sizeof adopt, .instance = instance, .physical_device = gpu, .device = vk_device,
                                     .queue_family = family, .enabled_features = &features,
                                     .get_proc = vkGetInstanceProcAddr};
    if (darkroom_device_adopt(&adopt, &device) != DARKROOM_OK) return report(darkroom_error());
    darkroom_composer_create(device, NULL, &composer);
    darkroom_composer_add(composer, "bloom", NULL, &bloom);
    darkroom_composer_set_number(composer, bloom, "intensity", 0.08);
    darkroom_composer_add(composer, "tonemap", NULL, NULL);
    darkroom_composer_add(composer, "encode", NULL, NULL);
    return 0;
}

static inline void usage_values(DarkroomComposer composer, DarkroomHandle bloom, float pulse) {
    DarkroomParameter intensity = 0;
    darkroom_composer_parameter(composer, bloom, "intensity", &intensity);    // once
    darkroom_composer_set_float(composer, intensity, 0.1f + 0.02f * pulse);   // every frame
}

static inline void usage_effects(void) {
    for (uint32_t i = 0; i < darkroom_effect_count(); ++i) {
        DarkroomEffectInfo info = {sizeof info};
        darkroom_effect_info(darkroom_effect_at(i), &info);
        printf("%s: %s\n", info.name, info.doc);
    }
}
