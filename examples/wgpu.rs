// SPDX-License-Identifier: MIT
// Darkroom in a host in Rust that draws with wgpu 30 on Vulkan: three pixels of light, developed between wgpu's own commands.
// Its crates are `darkroom` (share/darkroom/bindings/rust), `wgpu` with the feature `vulkan`, `ash` 0.38 and `pollster`.

#![allow(unsafe_op_in_unsafe_fn)] // Of Rust 2024: what is unsafe here is unsafe as a whole.

use ash::vk::{self, Handle};
use darkroom::{sys, AdoptDesc, CompileDesc, Composer, Device, EntryDesc, Frame, Image, ImageUse};
use std::ffi::c_void;
use wgpu::hal::api::Vulkan;

type AnyResult<T> = Result<T, Box<dyn std::error::Error>>;

const LIGHT: [f32; 12] = [0.18, 0.18, 0.18, 1.0, 0.5, 0.5, 0.5, 1.0, 2.0, 2.0, 2.0, 1.0];
const SIZE: wgpu::Extent3d = wgpu::Extent3d { width: 3, height: 1, depth_or_array_layers: 1 };

/// wgpu's device with what Darkroom needs, and a stack on it. wgpu enables neither of the two features by itself.
///
/// # Safety
/// The composer goes before the device, when its recordings have finished.
unsafe fn open(adapter: &wgpu::Adapter) -> AnyResult<(wgpu::Device, wgpu::Queue, Composer)> {
    let desc = wgpu::DeviceDescriptor::default();
    let mut synchronization = vk::PhysicalDeviceSynchronization2Features::default().synchronization2(true);
    let mut rendering = vk::PhysicalDeviceDynamicRenderingFeatures::default().dynamic_rendering(true);
    let opened = adapter.as_hal::<Vulkan>().ok_or("wgpu has no Vulkan")?.open_with_callback(
        desc.required_features,
        &desc.required_limits,
        &desc.memory_hints,
        Some(Box::new(|to| {
            *to.create_info = to.create_info.push_next(&mut synchronization).push_next(&mut rendering);
        })),
    )?;
    let (device, queue) = adapter.create_device_from_hal(opened, &desc)?;

    // What was enabled, said again, because Vulkan cannot be asked for it.
    let mut synchronization = vk::PhysicalDeviceSynchronization2Features::default().synchronization2(true);
    let mut rendering = vk::PhysicalDeviceDynamicRenderingFeatures::default().dynamic_rendering(true);
    let features = vk::PhysicalDeviceFeatures2::default().push_next(&mut synchronization).push_next(&mut rendering);
    let raw = device.as_hal::<Vulkan>().ok_or("wgpu has no Vulkan")?;
    let instance = raw.shared_instance();
    let adopt = AdoptDesc::default()
        .instance(instance.raw_instance().handle().as_raw() as *mut c_void)
        .physical_device(raw.raw_physical_device().as_raw() as *mut c_void)
        .device(raw.raw_device().handle().as_raw() as *mut c_void)
        .queue_family(raw.queue_family_index())
        .get_proc(instance.entry().static_fn().get_instance_proc_addr as *mut c_void)
        .enabled_features((&features as *const vk::PhysicalDeviceFeatures2).cast());
    let composer = Composer::create(&Device::adopt(&adopt)?, &Default::default())?;
    drop(raw);
    let exposure = composer.add(c"exposure", &EntryDesc::default())?;
    composer.set_number(exposure, c"exposure", 1.5)?;
    composer.add(c"tonemap", &EntryDesc::default())?;
    composer.add(c"encode", &EntryDesc::default())?;
    composer.compile(
        &CompileDesc::default()
            .max_extent(sys::VkExtent2D { width: SIZE.width, height: SIZE.height })
            .color(&ImageUse::default().format(vk::Format::R32G32B32A32_SFLOAT.as_raw())),
    )?;
    Ok((device, queue, composer))
}

/// A texture of wgpu's, in the layout that wgpu has left it in, and gets it back in. One guard of as_hal() at a time.
unsafe fn image_of(texture: &wgpu::Texture, view: &wgpu::TextureView, format: vk::Format, layout: vk::ImageLayout) -> Image {
    let image = texture.as_hal::<Vulkan>().unwrap().raw_handle();
    let view = view.as_hal::<Vulkan>().unwrap().raw_handle();
    Image::default()
        .image(image.as_raw())
        .view(view.as_raw())
        .format(format.as_raw())
        .extent(sys::VkExtent2D { width: SIZE.width, height: SIZE.height })
        .layout(layout.as_raw())
}

fn main() -> AnyResult<()> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::VULKAN,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    let (device, queue, composer) = unsafe { open(&adapter)? };
    let texture = |format, usage| {
        let made = device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: SIZE,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        });
        let view = made.create_view(&Default::default());
        (made, view)
    };
    let (color, color_view) = texture(
        wgpu::TextureFormat::Rgba32Float,
        wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
    );
    let (target, target_view) = texture(
        wgpu::TextureFormat::Rgba8Unorm,
        wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
    );
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 256,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });

    // wgpu's commands before: the light is written and becomes RESOURCE, which is SHADER_READ_ONLY_OPTIMAL. The target is
    // cleared, because wgpu fills with zeroes, at its next use, what it has never written; it is COLOR_TARGET then, which is
    // COLOR_ATTACHMENT_OPTIMAL.
    let light: Vec<u8> = LIGHT.iter().flat_map(|number| number.to_ne_bytes()).collect();
    let rows = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(48), rows_per_image: None };
    queue.write_texture(color.as_image_copy(), &light, rows, SIZE);
    let mut before = device.create_command_encoder(&Default::default());
    before.transition_resources(
        std::iter::empty(),
        std::iter::once(wgpu::wgt::TextureTransition {
            texture: &color,
            selector: None,
            state: wgpu::wgt::TextureUses::RESOURCE,
        }),
    );
    before.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &target_view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
        })],
        ..Default::default()
    });

    // Darkroom's, in an encoder of their own: wgpu allows no commands of its own beside raw ones.
    let mut between = device.create_command_encoder(&Default::default());
    unsafe {
        let frame_color =
            image_of(&color, &color_view, vk::Format::R32G32B32A32_SFLOAT, vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL);
        let frame_target =
            image_of(&target, &target_view, vk::Format::R8G8B8A8_UNORM, vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL);
        let commands = between.as_hal_mut::<Vulkan, _, _>(|encoder| encoder.unwrap().raw_handle());
        let frame = Frame::default().color(&frame_color).target(&frame_target);
        composer.record(commands.as_raw() as *mut c_void, &frame)?;
    }

    // wgpu's commands behind.
    let mut after = device.create_command_encoder(&Default::default());
    after.copy_texture_to_buffer(
        target.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(256), rows_per_image: None },
        },
        SIZE,
    );
    queue.submit([before.finish(), between.finish(), after.finish()]);
    buffer.slice(..).map_async(wgpu::MapMode::Read, |_| {});
    device.poll(wgpu::PollType::wait_indefinitely())?;
    for pixel in buffer.slice(..4 * u64::from(SIZE.width)).get_mapped_range()?.chunks(4) {
        println!("{} {} {}", pixel[0], pixel[1], pixel[2]);
    }
    Ok(())
}
