// SPDX-License-Identifier: MIT
#pragma once
// A scene or a model, drawn for a viewer.

#include <memory>

#include "live_source.hpp"
#include "scene/scene.hpp"

namespace app {

/// Do both see the scene from the same place?
[[nodiscard]] bool is_same_place(const darkroom::scene::OrbitOverride& a, const darkroom::scene::OrbitOverride& b);

class SceneSource final : public LiveSource {
  public:
    struct Desc {
        darkroom::render::RenderDesc render;
        std::uint64_t seed = 0;
        bool is_strict = false;
        darkroom::scene::NamedFiles named_files = darkroom::scene::NamedFiles::Any;
    };
    /// Reads the scene, uploads it. Errors are those of the file and the machine.
    [[nodiscard]] static darkroom::Result<std::unique_ptr<SceneSource>> create(darkroom::Device& device,
                                                                               const std::filesystem::path& file,
                                                                               const Desc& desc);
    [[nodiscard]] std::optional<VkExtent2D> extent() const override { return std::nullopt; }
    [[nodiscard]] bool must_wait(const LiveMoment& moment, VkExtent2D extent) const override;
    [[nodiscard]] bool is_another(const LiveMoment& moment) const override;
    [[nodiscard]] darkroom::Result<> prepare(const LiveMoment& moment, VkExtent2D extent) override;
    [[nodiscard]] bool is_kept() const override { return is_kept_; }
    [[nodiscard]] darkroom::Result<> record(VkCommandBuffer commands) override;
    [[nodiscard]] darkroom::Frame frame() const override;
    [[nodiscard]] darkroom::CompileDesc compile_desc(VkExtent2D most) const override;
    [[nodiscard]] std::optional<darkroom::ImageRef> display_picture() const override;
    [[nodiscard]] std::vector<std::filesystem::path> files() const override;
    [[nodiscard]] std::vector<std::string> warnings() const override { return warnings_; }

    [[nodiscard]] const darkroom::scene::Scene& scene() const { return scene_; }
    [[nodiscard]] const darkroom::scene::Assets& assets() const { return assets_; }
    /// The last one that was prepared.
    [[nodiscard]] const darkroom::scene::Snapshot& snapshot() const { return snapshot_; }

  private:
    SceneSource(darkroom::Device& device, std::filesystem::path file, const Desc& desc);
    [[nodiscard]] darkroom::Result<> read();
    [[nodiscard]] darkroom::Result<> use(bool is_display, const LiveMoment& moment, VkExtent2D extent);

    darkroom::Device& device_;
    std::filesystem::path file_;
    Desc desc_;
    darkroom::scene::Scene scene_;
    darkroom::scene::Assets assets_;
    darkroom::scene::Snapshot snapshot_;
    std::optional<darkroom::render::Renderer> linear_, display_;
    bool is_display_ = false, is_prepared_ = false;
    bool is_moved_ = false;  ///< by the time
    bool is_kept_ = false;   ///< the images hold the very frame that is asked for
    std::optional<std::pair<LiveMoment, VkExtent2D>> drawn_;
    std::vector<std::string> warnings_;
};

}  // namespace app
