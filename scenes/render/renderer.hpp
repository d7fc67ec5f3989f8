// SPDX-License-Identifier: MIT
#pragma once
// Draws snapshots of a scene: linear HDR colour with depth, normals, velocity and shadow maps for a Composer, or the
// finished display picture by the scene's own shaders. The multi-sampled scene is resolved once, for all effects.
//
//     auto renderer = Renderer::create(device, scene, assets, {.extent = {1280, 720}});
//     renderer->prepare(snapshot);
//     renderer->record(commands);      // then composer.record(commands, renderer->frame())
//
// Size and options change while it runs: resize() makes targets, set() nothing. Renderers of one scene share its
// assets: a display picture beside the linear one costs no second upload (sharing()).

#include <darkroom/device.hpp>
#include <darkroom/frame.hpp>
#include <darkroom/result.hpp>
#include <memory>
#include <string>

#include "render/frame_set.hpp"
#include "render/lens.hpp"
#include "render/shadow/cascades.hpp"
#include "scene/assets.hpp"
#include "scene/pose/snapshot.hpp"

namespace darkroom::render {

struct SceneOnDevice;

/// What may change from frame to frame. Nothing is uploaded for it; the pipelines of debug views, edges and arrows are
/// made by the prepare() that first needs them, or by warm_up(). Shadows and the grid need none of their own.
struct DrawOptions {
    bool has_shadows = true;  ///< a renderer that is made without them has no place for them and stays without
    bool has_grid = true;
    bool has_wireframe_overlay = false;
    bool has_normal_arrows = false;
    float mip_bias = 0;                 ///< of textures: Composer::mip_bias, where something enlarges the picture
    float exposure = 1;                 ///< multiplies light, but not in debug views; of Output::Display alone
    DebugView debug = DebugView::None;  ///< others need Output::Display, and are neither tone-mapped nor encoded
};

struct RenderDesc {
    VkExtent2D extent{1920, 1080};
    std::uint32_t samples = 1;  ///< of the rasteriser, for each position
    /// Places within the pixel that the scene is drawn from, [1, 1024]: linear light is their mean; the layers beside
    /// it are those of the pixel's centre. Output::Hdr only.
    std::uint32_t positions = 1;
    /// That mean is weighed by the inverse of one plus the largest channel, so that edges are as smooth as a display
    /// shows them; else it is of light itself.
    bool is_mean_weighed = true;
    /// With more than one position: each is seen from another place of the aperture. The layers are those of a pinhole.
    LensDesc lens;
    Output output = Output::Hdr;
    /// Of the picture for Output::Display; its first channels red, green, blue, alpha, sRGB-encoded by the shader.
    VkFormat display_format = VK_FORMAT_R8G8B8A8_UNORM;
    bool is_tone_mapped = true;  ///< Output::Display: ACES (Narkowicz) before encoding
    /// The frame has the colour before transparency: without grid, transparent meshes and particles. Of one sample and
    /// one position alone.
    bool has_transparency = false;
    CascadeDesc cascades;
    DrawOptions draw;
    std::uint32_t frames_in_flight = 1;
};

struct RenderCounters {
    std::uint64_t draw_calls = 0, instances = 0, culled = 0;  ///< of the last prepared frame, shadows included
    std::uint64_t resolves = 0;                               ///< since creation
};

class Renderer {
  public:
    /// Uploads the assets and compiles the pipelines; on any thread, while others draw. Errors: a size or a sample
    /// count that the device lacks (the text names those it has), a debug view with Output::Hdr, VkResult.
    [[nodiscard]] static Result<Renderer> create(Device& device, const scene::Scene& scene, const scene::Assets& assets,
                                                 const RenderDesc& desc);
    /// Another renderer of the same scene, which uploads nothing. Either may go first; those that share are used by one
    /// thread at a time. Errors are those of create().
    [[nodiscard]] Result<Renderer> sharing(const RenderDesc& desc) const;
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;
    ~Renderer();

    /// New targets, and nothing else: no upload and no pipeline. Every recording of this renderer, and of whoever reads
    /// its images, has finished. What frame() and picture() named is gone, and prepare() comes before the next
    /// record(). Errors: a size that the device lacks, VkResult; the old targets stay.
    Result<> resize(VkExtent2D extent);
    /// From the next prepare() on. Errors: a debug view with Output::Hdr, edges on a device that cannot draw them; the
    /// old options stay.
    Result<> set(const DrawOptions& options);

    /// Makes at once the pipelines of all options and of what the camera has not seen yet, for whoever cannot spare the
    /// time later: on the software driver a few ms for each kind of surface, and half a second where no cache knows the
    /// shaders.
    Result<> warm_up();

    /// Culls, sorts and fills the buffers of the next frame; the recording made `frames_in_flight` frames ago must have
    /// finished. The snapshot must stay until record() has returned. Errors are those of the machine.
    /// `jitter`: its picture is moved by that, its motion is not.
    Result<> prepare(const scene::Snapshot& snapshot, const FrameJitter& jitter = {});
    Result<> prepare(scene::Snapshot&& snapshot, const FrameJitter& jitter = {}) = delete;
    /// Records shadows, scene and resolve of what was prepared.
    Result<> record(VkCommandBuffer commands);

    /// The images as record() leaves them, the camera and the lights, for Composer::record. Depth is planar distance in
    /// R32F (1e10 where there is no surface). Lights refer to memory of the renderer. Target, frame_index and view are
    /// the caller's. Only for Output::Hdr, after a prepare().
    [[nodiscard]] Frame frame() const;
    /// What all of the frame's layers beside the colour were created for.
    [[nodiscard]] VkImageUsageFlags layer_usage() const;
    /// The picture of either output, as record() leaves it: TRANSFER_SRC_OPTIMAL for Display.
    [[nodiscard]] const ImageRef& picture() const;

    [[nodiscard]] const RenderCounters& counters() const;
    [[nodiscard]] const RenderDesc& desc() const;

  private:
    Renderer();
    [[nodiscard]] static Result<Renderer> create(gpu::Context& context, std::shared_ptr<SceneOnDevice> scene,
                                                 const RenderDesc& desc);
    struct State;
    std::unique_ptr<State> state_;
};

/// The sample counts that this device can render and resolve, as "1, 4".
[[nodiscard]] std::string sample_counts(const Device& device);

}  // namespace darkroom::render
