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
    void follow_worn_colourway(const Session& session);
    void draw_fibres(const ClothTable& table, float pixel_ratio);
    void draw_light();
    void draw_save(Session& session, std::filesystem::path& file);

    std::filesystem::path file_;
    std::shared_ptr<const Cloth> shown_; ///< of the session, from which `cloth_` started
    Cloth cloth_;                        ///< as the controls have it
    char target_[512] = {};              ///< name of the file to save as
    std::filesystem::path refused_;      ///< there is such a file: asked again, it is overwritten

    /// What disc and curves are of.
    struct Lobe {
        std::shared_ptr<const TableBsdf> table;
        glm::vec2 light{-0.5f, 0}; ///< where it comes from, on the disc (hemisphere.h)
        Side lit = Side::front, seen = Side::front;

        bool operator==(const Lobe&) const = default;
    };
    Lobe lobe_, mapped_;         ///< as chosen, and as it is drawn
    std::string colourway_;      ///< of disc, curves and fibres
    std::string worn_colourway_; ///< the last that was worn, which it follows
    std::unique_ptr<Texture> map_;
    FibreView fibres_;
    std::shared_ptr<const TracedPicture> shown_fibres_;
    std::unique_ptr<Texture> fibre_picture_;
    std::vector<float> weft_curve_, warp_curve_;
};

} // namespace rapport
