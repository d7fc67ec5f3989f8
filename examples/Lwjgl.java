// SPDX-License-Identifier: MIT
// Darkroom in a host in Java that calls Vulkan by LWJGL 3.3, and Darkroom by JNA (share/darkroom/bindings/Darkroom.java). It
// develops three pixels of light and prints them.
//     java -cp ... Lwjgl LIBRARY

import static org.lwjgl.system.MemoryStack.stackPush;
import static org.lwjgl.vulkan.VK13.*;

import com.sun.jna.Pointer;
import com.sun.jna.ptr.PointerByReference;
import java.nio.ByteBuffer;
import java.nio.LongBuffer;
import org.lwjgl.PointerBuffer;
import org.lwjgl.system.MemoryStack;
import org.lwjgl.system.MemoryUtil;
import org.lwjgl.vulkan.*;

final class Lwjgl {
    static final int WIDTH = 3, COLOR = VK_FORMAT_R32G32B32A32_SFLOAT, TARGET = VK_FORMAT_R8G8B8A8_UNORM;
    static final float[] LIGHT = {0.18f, 0.18f, 0.18f, 1, 0.5f, 0.5f, 0.5f, 1, 2, 2, 2, 1};

    static Darkroom.Functions darkroom;

    static void need(int result) {
        Darkroom.check(darkroom, result);
    }

    /** A stack on the host's device, which is adopted as it was created. */
    Pointer stack() {
        var adopt = new Darkroom.DarkroomAdoptDesc();
        adopt.instance = new Pointer(instance.address());
        adopt.physical_device = new Pointer(gpu.address());
        adopt.device = new Pointer(device.address());
        adopt.enabled_features = new Pointer(features.address());
        adopt.get_proc = new Pointer(VK.getFunctionProvider().getFunctionAddress("vkGetInstanceProcAddr"));
        var made = new PointerByReference();
        need(darkroom.darkroom_device_adopt(adopt, made));
        Pointer adopted = made.getValue();
        need(darkroom.darkroom_composer_create(adopted, null, made));
        Pointer composer = made.getValue();
        darkroom.darkroom_device_destroy(adopted);

        var exposure = new long[1];
        need(darkroom.darkroom_composer_add(composer, "exposure", null, exposure));
        need(darkroom.darkroom_composer_set_number(composer, exposure[0], "exposure", 1.5));
        need(darkroom.darkroom_composer_add(composer, "tonemap", null, null));
        need(darkroom.darkroom_composer_add(composer, "encode", null, null));
        var desc = new Darkroom.DarkroomCompileDesc();
        desc.max_extent.width = WIDTH;
        desc.max_extent.height = 1;
        desc.color = new Darkroom.DarkroomImageUse.ByReference();
        desc.color.format = COLOR;
        need(darkroom.darkroom_composer_compile(composer, desc, null));
        return composer;
    }

    static Darkroom.DarkroomImage.ByReference imageOf(long image, long view, int format, int layout, int finalLayout) {
        var out = new Darkroom.DarkroomImage.ByReference();
        out.image = image;
        out.view = view;
        out.format = format;
        out.extent.width = WIDTH;
        out.extent.height = 1;
        out.layout = layout;
        out.final_layout = finalLayout;
        return out;
    }

    public static void main(String[] arguments) {
        darkroom = Darkroom.load(arguments[0]);
        try (MemoryStack memory = stackPush()) {
            Lwjgl host = new Lwjgl(memory);
            Pointer composer = host.stack();
            long[] color = host.image(memory, COLOR, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
            long[] target = host.image(memory, TARGET, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
            host.upload(memory, color[0]);
            var frame = new Darkroom.DarkroomFrame();
            frame.color = imageOf(color[0], color[1], COLOR, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 0);
            frame.target = imageOf(target[0], target[1], TARGET, 0, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
            need(darkroom.darkroom_composer_record(composer, new Pointer(host.commands.address()), frame));
            ByteBuffer picture = host.finish(memory, target[0]);
            darkroom.darkroom_composer_destroy(composer);
            for (int i = 0; i < WIDTH; ++i)
                System.out.printf("%d %d %d%n", picture.get(4 * i) & 255, picture.get(4 * i + 1) & 255,
                        picture.get(4 * i + 2) & 255);
        }
    }

    // -----------------------------------------------------------------------------------------------------------------
    // The host: nothing of Darkroom. A program that ends at once leaves what it made to the driver.

    final VkInstance instance;
    final VkPhysicalDevice gpu;
    final VkDevice device;
    final VkPhysicalDeviceFeatures2 features;
    final VkCommandBuffer commands;
    final long buffer;
    final ByteBuffer mapped;

    static void check(int result) {
        if (result != VK_SUCCESS) throw new IllegalStateException("VkResult " + result);
    }

    Lwjgl(MemoryStack memory) {
        PointerBuffer pointer = memory.mallocPointer(1);
        LongBuffer number = memory.mallocLong(1);
        var application = VkApplicationInfo.calloc(memory).sType$Default().apiVersion(VK_API_VERSION_1_3);
        var instanceInfo = VkInstanceCreateInfo.calloc(memory).sType$Default().pApplicationInfo(application);
        check(vkCreateInstance(instanceInfo, null, pointer));
        instance = new VkInstance(pointer.get(0), instanceInfo);
        int result = vkEnumeratePhysicalDevices(instance, memory.ints(1), pointer);
        if (result != VK_INCOMPLETE) check(result);
        gpu = new VkPhysicalDevice(pointer.get(0), instance);
        // Kept for Darkroom, because Vulkan cannot be asked for it later.
        var features13 = VkPhysicalDeviceVulkan13Features.calloc(memory).sType$Default().synchronization2(true)
                .dynamicRendering(true);
        features = VkPhysicalDeviceFeatures2.calloc(memory).sType$Default().pNext(features13.address());
        var queues = VkDeviceQueueCreateInfo.calloc(1, memory).sType$Default().pQueuePriorities(memory.floats(1));
        var deviceInfo = VkDeviceCreateInfo.calloc(memory).sType$Default().pNext(features.address())
                .pQueueCreateInfos(queues);
        check(vkCreateDevice(gpu, deviceInfo, null, pointer));
        device = new VkDevice(pointer.get(0), gpu, deviceInfo);
        check(vkCreateCommandPool(device, VkCommandPoolCreateInfo.calloc(memory).sType$Default(), null, number));
        var commandsInfo = VkCommandBufferAllocateInfo.calloc(memory).sType$Default().commandPool(number.get(0))
                .commandBufferCount(1);
        check(vkAllocateCommandBuffers(device, commandsInfo, pointer));
        commands = new VkCommandBuffer(pointer.get(0), device);
        var bufferInfo = VkBufferCreateInfo.calloc(memory).sType$Default().size(256)
                .usage(VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
        check(vkCreateBuffer(device, bufferInfo, null, number));
        buffer = number.get(0);
        var needs = VkMemoryRequirements.calloc(memory);
        vkGetBufferMemoryRequirements(device, buffer, needs);
        long allocation = allocate(memory, needs,
                VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
        check(vkBindBufferMemory(device, buffer, allocation, 0));
        check(vkMapMemory(device, allocation, 0, VK_WHOLE_SIZE, 0, pointer));
        mapped = MemoryUtil.memByteBuffer(pointer.get(0), 256);
        check(vkBeginCommandBuffer(commands, VkCommandBufferBeginInfo.calloc(memory).sType$Default()));
    }

    long allocate(MemoryStack memory, VkMemoryRequirements needs, int wanted) {
        var all = VkPhysicalDeviceMemoryProperties.calloc(memory);
        vkGetPhysicalDeviceMemoryProperties(gpu, all);
        int type = 0;
        while ((needs.memoryTypeBits() >> type & 1) == 0 || (all.memoryTypes(type).propertyFlags() & wanted) != wanted) ++type;
        LongBuffer out = memory.mallocLong(1);
        var info = VkMemoryAllocateInfo.calloc(memory).sType$Default().allocationSize(needs.size()).memoryTypeIndex(type);
        check(vkAllocateMemory(device, info, null, out));
        return out.get(0);
    }

    /** An image and its view. */
    long[] image(MemoryStack memory, int format, int usage) {
        LongBuffer number = memory.mallocLong(1);
        var info = VkImageCreateInfo.calloc(memory).sType$Default().imageType(VK_IMAGE_TYPE_2D).format(format)
                .extent(size -> size.set(WIDTH, 1, 1)).mipLevels(1).arrayLayers(1).samples(VK_SAMPLE_COUNT_1_BIT).usage(usage);
        check(vkCreateImage(device, info, null, number));
        long image = number.get(0);
        var needs = VkMemoryRequirements.calloc(memory);
        vkGetImageMemoryRequirements(device, image, needs);
        check(vkBindImageMemory(device, image, allocate(memory, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT), 0));
        var view = VkImageViewCreateInfo.calloc(memory).sType$Default().image(image).viewType(VK_IMAGE_VIEW_TYPE_2D)
                .format(format).subresourceRange(range -> range.set(VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1));
        check(vkCreateImageView(device, view, null, number));
        return new long[] {image, number.get(0)};
    }

    VkBufferImageCopy.Buffer whole(MemoryStack memory) {
        return VkBufferImageCopy.calloc(1, memory)
                .imageSubresource(layers -> layers.set(VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1))
                .imageExtent(size -> size.set(WIDTH, 1, 1));
    }

    void barrier(MemoryStack memory, long stage, long access, long toStage, long toAccess) {
        var barrier = VkMemoryBarrier2.calloc(1, memory).sType$Default().srcStageMask(stage).srcAccessMask(access)
                .dstStageMask(toStage).dstAccessMask(toAccess);
        vkCmdPipelineBarrier2(commands, VkDependencyInfo.calloc(memory).sType$Default().pMemoryBarriers(barrier));
    }

    /** The light, in TRANSFER_DST_OPTIMAL. */
    void upload(MemoryStack memory, long image) {
        mapped.asFloatBuffer().put(LIGHT);
        var barrier = VkImageMemoryBarrier2.calloc(1, memory).sType$Default().dstStageMask(VK_PIPELINE_STAGE_2_COPY_BIT)
                .dstAccessMask(VK_ACCESS_2_TRANSFER_WRITE_BIT).newLayout(VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL).image(image)
                .subresourceRange(range -> range.set(VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1));
        vkCmdPipelineBarrier2(commands, VkDependencyInfo.calloc(memory).sType$Default().pImageMemoryBarriers(barrier));
        vkCmdCopyBufferToImage(commands, buffer, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, whole(memory));
    }

    /** The target, which is in TRANSFER_SRC_OPTIMAL. */
    ByteBuffer finish(MemoryStack memory, long target) {
        // The light has been read from the buffer before.
        barrier(memory, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, VK_PIPELINE_STAGE_2_COPY_BIT,
                VK_ACCESS_2_TRANSFER_WRITE_BIT);
        vkCmdCopyImageToBuffer(commands, target, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, whole(memory));
        barrier(memory, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT,
                VK_ACCESS_2_HOST_READ_BIT);
        check(vkEndCommandBuffer(commands));
        PointerBuffer pointer = memory.mallocPointer(1);
        vkGetDeviceQueue(device, 0, 0, pointer);
        VkQueue queue = new VkQueue(pointer.get(0), device);
        var submission = VkSubmitInfo.calloc(memory).sType$Default().pCommandBuffers(memory.pointers(commands));
        check(vkQueueSubmit(queue, submission, VK_NULL_HANDLE));
        check(vkQueueWaitIdle(queue));
        return mapped;
    }
}
