// SPDX-License-Identifier: MIT
// Darkroom inside a host in C: the host (host.h) makes its instance, device, images and command buffer the ordinary way,
// draws an HDR picture, lets Darkroom record its stack between commands of its own, and saves the result.
//     embed_c [PICTURE.ppm [KERNELS.dkb]]
// The second file holds the kernels of the stack, from `darkroom bake`; without it the library compiles them.

#include <darkroom/darkroom.h>

#include "host.h"

static void need(DarkroomResult result) {
    if (result == DARKROOM_OK) return;
    fprintf(stderr, "embed_c: %s\n", darkroom_error());
    exit(2);
}

int main(int argc, char** argv) {
    Host host = {0};
    create_device(&host);
    const VkFormat hdr_format = VK_FORMAT_R16G16B16A16_SFLOAT, target_format = VK_FORMAT_R8G8B8A8_UNORM;
    const Image hdr = create_image(&host, hdr_format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    const Image target =
        create_image(&host, target_format, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    const Output output = create_output(&host);

    size_t kernels_size = 0;
    void* const kernels = argc > 2 ? load(argv[2], &kernels_size) : NULL;

    // Once. Darkroom owns nothing of the host's.
    const DarkroomAdoptDesc adopt = {sizeof adopt, .instance = host.instance, .physical_device = host.gpu,
                                     .device = host.device, .queue_family = host.family,
                                     .enabled_features = &host.features, .get_proc = vkGetInstanceProcAddr,
                                     .kernels = kernels, .kernels_size = kernels_size};
    DarkroomDevice device = NULL;
    need(darkroom_device_adopt(&adopt, &device));
    free(kernels);
    DarkroomComposer composer = NULL;
    need(darkroom_composer_create(device, NULL, &composer));
    DarkroomHandle bloom = 0, exposure = 0;
    need(darkroom_composer_add(composer, "bloom", NULL, &bloom));
    need(darkroom_composer_set_number(composer, bloom, "intensity", 0.08));
    need(darkroom_composer_add(composer, "exposure", NULL, &exposure));
    need(darkroom_composer_set_number(composer, exposure, "exposure", 1.5));
    need(darkroom_composer_add(composer, "tonemap", NULL, NULL));
    need(darkroom_composer_add(composer, "encode", NULL, NULL));
    const DarkroomCompileDesc frames = {sizeof frames, .max_extent = {width, height}};
    need(darkroom_composer_compile(composer, &frames, NULL));

    // Every frame: Darkroom is told how the images are and how to leave them, and places its own barriers in between.
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    check(vkBeginCommandBuffer(output.commands, &begin), "vkBeginCommandBuffer");
    draw_scene(output.commands, hdr);
    const DarkroomImage color = {sizeof color, .image = hdr.image, .view = hdr.view, .format = hdr_format,
                                 .extent = {width, height}, .layout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const DarkroomImage picture = {sizeof picture, .image = target.image, .view = target.view, .format = target_format,
                                   .extent = {width, height}, .final_layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    const DarkroomFrame frame = {sizeof frame, .color = &color, .target = &picture};
    need(darkroom_composer_record(composer, output.commands, &frame));
    submit(&host, output, target);

    // A composer goes only when its recordings have finished.
    darkroom_composer_destroy(composer);
    darkroom_device_destroy(device);
    save(&host, output, argc > 1 ? argv[1] : "embed_c.ppm");

    destroy_output(&host, output);
    destroy_image(&host, hdr);
    destroy_image(&host, target);
    destroy_device(&host);
    return 0;
}
