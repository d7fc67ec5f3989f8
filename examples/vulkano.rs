// SPDX-License-Identifier: MIT
// Darkroom in a host in Rust that draws with vulkano 0.35: three pixels of light, developed in a command buffer that the host
// records itself, because vulkano's automatic one must know of every command.
// Its crates are `darkroom` (share/darkroom/bindings/rust), `vulkano` and `ash` 0.38, whose types vulkano's handles are.

#![allow(unsafe_op_in_unsafe_fn)] // Of Rust 2024: what is unsafe here is unsafe as a whole.

use ash::vk::{self, Handle};
use darkroom::{sys, AdoptDesc, CompileDesc, Composer, EntryDesc, Frame, ImageUse};
use std::{ffi::c_void, sync::Arc};
use vulkano::buffer::{Buffer, BufferCreateInfo, BufferUsage, Subbuffer};
use vulkano::command_buffer::allocator::StandardCommandBufferAllocator;
use vulkano::command_buffer::{CommandBufferLevel, CopyBufferToImageInfo, CopyImageToBufferInfo, RecordingCommandBuffer};
use vulkano::device::{Device, DeviceCreateInfo, DeviceFeatures, Queue, QueueCreateInfo};
use vulkano::format::Format;
use vulkano::image::{view::ImageView, Image, ImageCreateInfo, ImageLayout, ImageUsage};
use vulkano::instance::{Instance, InstanceCreateInfo};
use vulkano::memory::allocator::{AllocationCreateInfo, MemoryTypeFilter, StandardMemoryAllocator};
use vulkano::sync::{AccessFlags, DependencyInfo, ImageMemoryBarrier, MemoryBarrier, PipelineStages};
use vulkano::{Version, VulkanLibrary, VulkanObject};

type AnyResult<T> = Result<T, Box<dyn std::error::Error>>;

const LIGHT: [f32; 12] = [0.18, 0.18, 0.18, 1.0, 0.5, 0.5, 0.5, 1.0, 2.0, 2.0, 2.0, 1.0];
const EXTENT: sys::VkExtent2D = sys::VkExtent2D { width: 3, height: 1 };
const COLOR: Format = Format::R32G32B32A32_SFLOAT;
const TARGET: Format = Format::R8G8B8A8_UNORM;

/// A stack on vulkano's device.
///
/// # Safety
/// The composer goes before the device, when its recordings have finished.
unsafe fn stack(device: &Arc<Device>, queue: &Queue) -> AnyResult<Composer> {
    // What was enabled, said again, because Vulkan cannot be asked for it.
    let mut features13 =
        vk::PhysicalDeviceVulkan13Features::default().synchronization2(true).dynamic_rendering(true);
    let features = vk::PhysicalDeviceFeatures2::default().push_next(&mut features13);
    let library = device.instance().library();
    let get_proc = library.get_instance_proc_addr(vk::Instance::null(), c"vkGetInstanceProcAddr".as_ptr());
    let adopt = AdoptDesc::default()
        .instance(device.instance().handle().as_raw() as *mut c_void)
        .physical_device(device.physical_device().handle().as_raw() as *mut c_void)
        .device(device.handle().as_raw() as *mut c_void)
        .queue_family(queue.queue_family_index())
        .get_proc(get_proc.ok_or("no vkGetInstanceProcAddr")? as *mut c_void)
        .enabled_features((&features as *const vk::PhysicalDeviceFeatures2).cast());
    let composer = Composer::create(&darkroom::Device::adopt(&adopt)?, &Default::default())?;
    let exposure = composer.add(c"exposure", &EntryDesc::default())?;
    composer.set_number(exposure, c"exposure", 1.5)?;
    composer.add(c"tonemap", &EntryDesc::default())?;
    composer.add(c"encode", &EntryDesc::default())?;
    composer.compile(&CompileDesc::default().max_extent(EXTENT).color(&ImageUse::default().format(COLOR as i32)))?;
    Ok(composer)
}

fn image_of(view: &ImageView, layout: ImageLayout, final_layout: ImageLayout) -> darkroom::Image {
    darkroom::Image::default()
        .image(view.image().handle().as_raw())
        .view(view.handle().as_raw())
        .format(view.format() as i32)
        .extent(EXTENT)
        .layout(layout as i32)
        .final_layout(final_layout as i32)
}

fn main() -> AnyResult<()> {
    let instance = Instance::new(
        VulkanLibrary::new()?,
        InstanceCreateInfo { max_api_version: Some(Version::V1_3), ..Default::default() },
    )?;
    let gpu = instance.enumerate_physical_devices()?.next().ok_or("no Vulkan device")?;
    let (device, mut queues) = Device::new(
        gpu,
        DeviceCreateInfo {
            enabled_features: DeviceFeatures { synchronization2: true, dynamic_rendering: true, ..Default::default() },
            queue_create_infos: vec![QueueCreateInfo { queue_family_index: 0, ..Default::default() }],
            ..Default::default()
        },
    )?;
    let queue = queues.next().ok_or("no queue")?;
    let composer = unsafe { stack(&device, &queue)? };

    let allocator = Arc::new(StandardMemoryAllocator::new_default(device.clone()));
    let image = |format, usage| -> AnyResult<Arc<ImageView>> {
        let info = ImageCreateInfo { format, usage, extent: [EXTENT.width, EXTENT.height, 1], ..Default::default() };
        Ok(ImageView::new_default(Image::new(allocator.clone(), info, Default::default())?)?)
    };
    let color = image(COLOR, ImageUsage::SAMPLED | ImageUsage::TRANSFER_DST)?;
    let target = image(TARGET, ImageUsage::COLOR_ATTACHMENT | ImageUsage::TRANSFER_SRC)?;
    let mapped = |filter| AllocationCreateInfo { memory_type_filter: filter, ..Default::default() };
    let light = Buffer::from_iter(
        allocator.clone(),
        BufferCreateInfo { usage: BufferUsage::TRANSFER_SRC, ..Default::default() },
        mapped(MemoryTypeFilter::PREFER_DEVICE | MemoryTypeFilter::HOST_SEQUENTIAL_WRITE),
        LIGHT,
    )?;
    let picture: Subbuffer<[u8]> = Buffer::new_slice(
        allocator.clone(),
        BufferCreateInfo { usage: BufferUsage::TRANSFER_DST, ..Default::default() },
        mapped(MemoryTypeFilter::PREFER_HOST | MemoryTypeFilter::HOST_RANDOM_ACCESS),
        u64::from(4 * EXTENT.width),
    )?;

    let commands = unsafe {
        let allocator = Arc::new(StandardCommandBufferAllocator::new(device.clone(), Default::default()));
        let mut commands = RecordingCommandBuffer::new(
            allocator,
            queue.queue_family_index(),
            CommandBufferLevel::Primary,
            Default::default(),
        )?;
        let mut to_write = ImageMemoryBarrier::image(color.image().clone());
        to_write.dst_stages = PipelineStages::COPY;
        to_write.dst_access = AccessFlags::TRANSFER_WRITE;
        to_write.new_layout = ImageLayout::TransferDstOptimal;
        to_write.subresource_range = color.image().subresource_range();
        commands.pipeline_barrier(&DependencyInfo { image_memory_barriers: vec![to_write].into(), ..Default::default() })?;
        commands.copy_buffer_to_image(&CopyBufferToImageInfo::buffer_image(light.clone(), color.image().clone()))?;

        // What vulkano does not know of stands between commands that say their layouts.
        let frame_color = image_of(&color, ImageLayout::TransferDstOptimal, ImageLayout::Undefined);
        let frame_target = image_of(&target, ImageLayout::Undefined, ImageLayout::TransferSrcOptimal);
        composer.record(
            commands.handle().as_raw() as *mut c_void,
            &Frame::default().color(&frame_color).target(&frame_target),
        )?;

        commands.copy_image_to_buffer(&CopyImageToBufferInfo::image_buffer(target.image().clone(), picture.clone()))?;
        let to_host = MemoryBarrier {
            src_stages: PipelineStages::COPY,
            src_access: AccessFlags::TRANSFER_WRITE,
            dst_stages: PipelineStages::HOST,
            dst_access: AccessFlags::HOST_READ,
            ..Default::default()
        };
        commands.pipeline_barrier(&DependencyInfo { memory_barriers: vec![to_host].into(), ..Default::default() })?;
        commands.end()?
    };
    unsafe {
        let buffers = [commands.handle()];
        let submission = vk::SubmitInfo::default().command_buffers(&buffers);
        queue.with(|mut guard| -> AnyResult<()> {
            (device.fns().v1_0.queue_submit)(queue.handle(), 1, &submission, vk::Fence::null()).result()?;
            Ok(guard.wait_idle()?)
        })?;
    }
    for pixel in picture.read()?.chunks(4) {
        println!("{} {} {}", pixel[0], pixel[1], pixel[2]);
    }
    Ok(())
}
