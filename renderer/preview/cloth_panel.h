#pragma once

#include "renderer/preview/fibre_view.h"
#include "renderer/preview/session.h"
#include "renderer/preview/window.h"

namespace rapport {

/// The cloth editor: weave, sett, yarns and fibres of one cloth file, and what it does with light.
class ClothPanel {
  public:
    /// Draws it into the current ImGui window for the cloth `file` of the session, which is another
    /// once that has been saved as such.
    void draw(Session& session, std::filesystem::path& file, float pixel_ratio);

  private:
    void draw_fibres(const ClothTable& table, float pixel_ratio);
    void draw_light(const ClothTable& table);
    void draw_save(Session& session, std::filesystem::path& file);

    std::filesystem::path file_;
    std::shared_ptr<const Cloth> shown_; ///< of the session, from which `cloth_` started
    Cloth cloth_;                        ///< as the controls have it
    char target_[512] = {};              ///< name of the file to save as
    std::filesystem::path refused_;      ///< there is such a file: asked again, it is overwritten

    glm::vec2 light_{-0.5f, 0}; ///< where it comes from, on the disc (hemisphere.h)
    bool transmitted_ = false;
    std::shared_ptr<const TableBsdf> mapped_; ///< of which the map and curves are
    glm::vec2 mapped_light_{0};
    bool mapped_transmitted_ = false;
    std::unique_ptr<Texture> map_;
    FibreView fibres_;
    std::shared_ptr<const TracedPicture> shown_fibres_;
    std::unique_ptr<Texture> fibre_picture_;
    std::vector<float> weft_curve_, warp_curve_;
};

} // namespace rapport
