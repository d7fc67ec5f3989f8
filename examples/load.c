// SPDX-License-Identifier: MIT
// A host (host.h) that opens libdarkroom while it runs, and goes on without it: it shows its scene as it is then, by the
// same lines.
//     load PICTURE.ppm [LIBRARY]

#include <darkroom/darkroom_load.h>

#include "host.h"

static DarkroomInstance darkroom;

static void need(DarkroomResult result) {
    if (result == DARKROOM_OK) return;
    fprintf(stderr, "load: %s\n", darkroom.error());
    exit(2);
}

int main(int argc, char** argv) {
    Host host = {0};
    create_device(&host);
    const VkFormat hdr_format = VK_FORMAT_R16G16B16A16_SFLOAT, target_format = VK_FORMAT_R8G8B8A8_UNORM;
    const Image hdr = create_image(&host, hdr_format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                                          VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    const Image target = create_image(&host, target_format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                                                VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                                                VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    const Output output = create_output(&host);

    darkroom = darkroom_load(argc > 2 ? argv[2] : NULL, NULL, NULL);
    const DarkroomAdoptDesc adopt = {sizeof adopt, .instance = host.instance, .physical_device = host.gpu,
                                     .device = host.device, .queue_family = host.family,
                                     .enabled_features = &host.features, .get_proc = vkGetInstanceProcAddr};
    DarkroomDevice device = NULL;
    need(darkroom.device_adopt(&adopt, &device));
    DarkroomComposer composer = NULL;
    need(darkroom.composer_create(device, NULL, &composer));
    DarkroomHandle bloom = 0, exposure = 0;
    need(darkroom.composer_add(composer, "bloom", NULL, &bloom));
    need(darkroom.composer_set_number(composer, bloom, "intensity", 0.08));
    need(darkroom.composer_add(composer, "exposure", NULL, &exposure));
    need(darkroom.composer_set_number(composer, exposure, "exposure", 1.5));
    need(darkroom.composer_add(composer, "tonemap", NULL, NULL));
    need(darkroom.composer_add(composer, "encode", NULL, NULL));
    const DarkroomCompileDesc frames = {sizeof frames, .max_extent = {width, height}};
    need(darkroom.composer_compile(composer, &frames, NULL));

    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    check(vkBeginCommandBuffer(output.commands, &begin), "vkBeginCommandBuffer");
    draw_scene(output.commands, hdr);
    copy_scene(output.commands, hdr, target);  // what is shown without Darkroom
    const DarkroomImage color = {sizeof color, .image = hdr.image, .view = hdr.view, .format = hdr_format,
                                 .extent = {width, height}, .layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    const DarkroomImage picture = {sizeof picture, .image = target.image, .view = target.view, .format = target_format,
                                   .extent = {width, height}, .layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    const DarkroomFrame frame = {sizeof frame, .color = &color, .target = &picture};
    need(darkroom.composer_record(composer, output.commands, &frame));
    submit(&host, output, target);

    darkroom.composer_destroy(composer);
    darkroom.device_destroy(device);
    save(&host, output, argc > 1 ? argv[1] : "load.ppm");
    destroy_output(&host, output);
    destroy_image(&host, hdr);
    destroy_image(&host, target);
    destroy_device(&host);
    return 0;
}
