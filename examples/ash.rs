// SPDX-License-Identifier: MIT
// Darkroom in a host in Rust that draws with ash 0.38: three pixels of light, developed in the host's own command buffer.
// Its crates are `darkroom` (share/darkroom/bindings/rust) and `ash` with the feature `loaded`.

#![allow(unsafe_op_in_unsafe_fn)] // Of Rust 2024: what is unsafe here is unsafe as a whole.

use ash::vk::{self, Handle};
use darkroom::{sys, AdoptDesc, CompileDesc, Composer, Device, EntryDesc, Frame, Image, ImageUse};
use std::ffi::c_void;

type AnyResult<T> = Result<T, Box<dyn std::error::Error>>;

const LIGHT: [f32; 12] = [0.18, 0.18, 0.18, 1.0, 0.5, 0.5, 0.5, 1.0, 2.0, 2.0, 2.0, 1.0];
const WIDTH: u32 = 3;
const COLOR: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const TARGET: vk::Format = vk::Format::R8G8B8A8_UNORM;
const TO_READ: vk::ImageLayout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;

/// A stack on the host's device, which is adopted as it was created.
///
/// # Safety
/// The objects are the host's own; they outlive the composer.
unsafe fn stack(host: &Host) -> Result<Composer, darkroom::Error> {
    let get_proc: unsafe extern "system" fn(vk::Instance, *const i8) -> vk::PFN_vkVoidFunction =
        std::mem::transmute(host.entry.static_fn().get_instance_proc_addr);
    let adopt = AdoptDesc::default()
        .instance(host.instance.handle().as_raw() as *mut c_void)
        .physical_device(host.gpu.as_raw() as *mut c_void)
        .device(host.device.handle().as_raw() as *mut c_void)
        .queue_family(0)
        .get_proc(get_proc as *mut c_void)
        .enabled_features((&host.features as *const vk::PhysicalDeviceFeatures2).cast());
    let composer = Composer::create(&Device::adopt(&adopt)?, &Default::default())?;
    let exposure = composer.add(c"exposure", &EntryDesc::default())?;
    composer.set_number(exposure, c"exposure", 1.5)?;
    composer.add(c"tonemap", &EntryDesc::default())?;
    composer.add(c"encode", &EntryDesc::default())?;
    composer.compile(
        &CompileDesc::default()
            .max_extent(sys::VkExtent2D { width: WIDTH, height: 1 })
            .color(&ImageUse::default().format(COLOR.as_raw()))
            .target(&ImageUse::default().format(TARGET.as_raw())),
    )?;
    Ok(composer)
}

fn image_of(image: vk::Image, view: vk::ImageView, format: vk::Format) -> Image {
    Image::default()
        .image(image.as_raw())
        .view(view.as_raw())
        .format(format.as_raw())
        .extent(sys::VkExtent2D { width: WIDTH, height: 1 })
}

fn main() -> AnyResult<()> {
    unsafe {
        let host = Host::new()?;
        let composer = stack(&host)?;
        let (color, color_view) = host.image(COLOR, vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST)?;
        let (target, target_view) =
            host.image(TARGET, vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC)?;
        host.commands_begin()?;
        host.upload(color);
        composer.record(
            host.commands.as_raw() as *mut c_void,
            &Frame::default()
                .color(&image_of(color, color_view, COLOR).layout(vk::ImageLayout::TRANSFER_DST_OPTIMAL.as_raw()))
                .target(&image_of(target, target_view, TARGET).final_layout(TO_READ.as_raw())),
        )?;
        for pixel in host.finish(target)?.chunks(4) {
            println!("{} {} {}", pixel[0], pixel[1], pixel[2]);
        }
    }
    Ok(())
}

// ---------------------------------------------------------------------------------------------------------------------
// The host: nothing of Darkroom. A program that ends at once leaves what it made to the driver.

struct Host {
    entry: ash::Entry,
    instance: ash::Instance,
    gpu: vk::PhysicalDevice,
    device: ash::Device,
    features: vk::PhysicalDeviceFeatures2<'static>,
    commands: vk::CommandBuffer,
    buffer: vk::Buffer,
    mapped: *mut c_void,
}

impl Host {
    unsafe fn new() -> AnyResult<Self> {
        let entry = ash::Entry::load()?;
        let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_3);
        let instance = entry.create_instance(&vk::InstanceCreateInfo::default().application_info(&application), None)?;
        let gpu = instance.enumerate_physical_devices()?[0];
        // Kept for Darkroom, because Vulkan cannot be asked for it later.
        let features13 = Box::leak(Box::new(
            vk::PhysicalDeviceVulkan13Features::default().synchronization2(true).dynamic_rendering(true),
        ));
        let mut features = vk::PhysicalDeviceFeatures2::default().push_next(features13);
        let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(0).queue_priorities(&[1.0])];
        let device_info = vk::DeviceCreateInfo::default().queue_create_infos(&queues).push_next(&mut features);
        let device = instance.create_device(gpu, &device_info, None)?;
        let pool = device.create_command_pool(&vk::CommandPoolCreateInfo::default(), None)?;
        let commands = device.allocate_command_buffers(
            &vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(1),
        )?[0];
        let buffer = device.create_buffer(
            &vk::BufferCreateInfo::default()
                .size(256)
                .usage(vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST),
            None,
        )?;
        let mut host = Self { entry, instance, gpu, device, features, commands, buffer, mapped: std::ptr::null_mut() };
        let needs = host.device.get_buffer_memory_requirements(buffer);
        let memory = host.allocate(needs, vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT)?;
        host.device.bind_buffer_memory(buffer, memory, 0)?;
        host.mapped = host.device.map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty())?;
        Ok(host)
    }

    unsafe fn allocate(&self, needs: vk::MemoryRequirements, wanted: vk::MemoryPropertyFlags) -> AnyResult<vk::DeviceMemory> {
        let all = self.instance.get_physical_device_memory_properties(self.gpu);
        let fits = |i: &u32| needs.memory_type_bits >> i & 1 == 1 && all.memory_types[*i as usize].property_flags.contains(wanted);
        let memory_type = (0..all.memory_type_count).find(fits).ok_or("no memory fits")?;
        let info = vk::MemoryAllocateInfo::default().allocation_size(needs.size).memory_type_index(memory_type);
        Ok(self.device.allocate_memory(&info, None)?)
    }

    unsafe fn image(&self, format: vk::Format, usage: vk::ImageUsageFlags) -> AnyResult<(vk::Image, vk::ImageView)> {
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(vk::Extent3D { width: WIDTH, height: 1, depth: 1 })
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .usage(usage);
        let image = self.device.create_image(&info, None)?;
        let memory =
            self.allocate(self.device.get_image_memory_requirements(image), vk::MemoryPropertyFlags::DEVICE_LOCAL)?;
        self.device.bind_image_memory(image, memory, 0)?;
        let view = vk::ImageViewCreateInfo::default()
            .image(image)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(format)
            .subresource_range(range());
        Ok((image, self.device.create_image_view(&view, None)?))
    }

    unsafe fn commands_begin(&self) -> AnyResult<()> {
        Ok(self.device.begin_command_buffer(self.commands, &vk::CommandBufferBeginInfo::default())?)
    }

    /// The light, in TRANSFER_DST_OPTIMAL.
    unsafe fn upload(&self, image: vk::Image) {
        self.mapped.cast::<[f32; 12]>().write(LIGHT);
        let barrier = [vk::ImageMemoryBarrier2::default()
            .dst_stage_mask(vk::PipelineStageFlags2::COPY)
            .dst_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
            .new_layout(vk::ImageLayout::TRANSFER_DST_OPTIMAL)
            .image(image)
            .subresource_range(range())];
        self.device.cmd_pipeline_barrier2(self.commands, &vk::DependencyInfo::default().image_memory_barriers(&barrier));
        let layout = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
        self.device.cmd_copy_buffer_to_image(self.commands, self.buffer, image, layout, &[whole()]);
    }

    /// The target, which is in TO_READ, as bytes.
    unsafe fn finish(&self, target: vk::Image) -> AnyResult<Vec<u8>> {
        // The light has been read from the buffer before.
        let barrier = [vk::MemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::COPY)
            .src_access_mask(vk::AccessFlags2::TRANSFER_READ)
            .dst_stage_mask(vk::PipelineStageFlags2::COPY)
            .dst_access_mask(vk::AccessFlags2::TRANSFER_WRITE)];
        self.device.cmd_pipeline_barrier2(self.commands, &vk::DependencyInfo::default().memory_barriers(&barrier));
        self.device.cmd_copy_image_to_buffer(self.commands, target, TO_READ, self.buffer, &[whole()]);
        let to_host = [vk::MemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::COPY)
            .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
            .dst_stage_mask(vk::PipelineStageFlags2::HOST)
            .dst_access_mask(vk::AccessFlags2::HOST_READ)];
        self.device.cmd_pipeline_barrier2(self.commands, &vk::DependencyInfo::default().memory_barriers(&to_host));
        self.device.end_command_buffer(self.commands)?;
        let queue = self.device.get_device_queue(0, 0);
        let commands = [self.commands];
        self.device.queue_submit(queue, &[vk::SubmitInfo::default().command_buffers(&commands)], vk::Fence::null())?;
        self.device.queue_wait_idle(queue)?;
        Ok(std::slice::from_raw_parts(self.mapped.cast::<u8>(), 4 * WIDTH as usize).to_vec())
    }
}

fn range() -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange { aspect_mask: vk::ImageAspectFlags::COLOR, level_count: 1, layer_count: 1, ..Default::default() }
}

fn whole() -> vk::BufferImageCopy {
    vk::BufferImageCopy::default()
        .image_subresource(vk::ImageSubresourceLayers {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            layer_count: 1,
            ..Default::default()
        })
        .image_extent(vk::Extent3D { width: WIDTH, height: 1, depth: 1 })
}
