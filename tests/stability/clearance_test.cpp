#include "vgsp/micro_element.h"

#include "vgsp/element_report.h"

#include <filesystem>
#include <gtest/gtest.h>

// Fibres keep clear of each other, however irregular they are: what overlap is left (within yarns
// by rounding, between yarns by their wandering) stays below half a percent of their surface.

namespace rapport {
namespace {

constexpr double kMostOverlap = 0.005;
const MicroElementOptions kCoarse{.max_turn_degrees = 2};

/// The overlap if the fibres had kept all of their volume.
double overlap_unthinned(const MicroElement& element) {
    kernel::FibreAssembly fibres = element.fibres;
    for (kernel::FibreChain& chain : fibres.chains)
        chain.radius /= std::sqrt(1 - element.thinned);
    return overlap_fraction(fibres, kernel::fibre_segments(fibres));
}

TEST(Clearance, OfEveryShippedCloth) {
    for (const auto& file :
         std::filesystem::directory_iterator(RAPPORT_SOURCE_DIR "/scenes/cloths"))
        if (file.path().extension() == ".toml") {
            const MicroElement element = build_micro_element(read_cloth(file.path()), kCoarse);
            EXPECT_LT(element.overlap_fraction, kMostOverlap) << file.path();
            EXPECT_LT(element.thinned, 0.1) << file.path();
        }
}

TEST(Clearance, HoldsForUnevenAndWanderingFibres) {
    for (const double variation : {0.1, 0.2})
        for (const double migration : {3.0}) {
            Cloth cloth;
            cloth.path = "dense.toml";
            cloth.draft = named_weave("plain");
            cloth.ends_per_cm = cloth.picks_per_cm = 35;
            for (YarnSpec* yarn : {&cloth.warp, &cloth.weft}) {
                yarn->section = YarnSection::twisted;
                yarn->fibres = 61;
                yarn->width_um = yarn->height_um = 150;
                yarn->twist_per_m = 600;
                yarn->fibre.diameter_um = 15.5;
                yarn->fibre.refractive_index = 1.5;
                yarn->fibre.diameter_variation = variation;
                yarn->irregularity.migration_um = migration;
                yarn->irregularity.deviation_degrees = migration;
            }
            const MicroElement element = build_micro_element(cloth);
            EXPECT_LT(element.overlap_fraction, kMostOverlap) << variation << ' ' << migration;
            EXPECT_GT(overlap_unthinned(element), kMostOverlap) << variation << ' ' << migration;
        }
}

} // namespace
} // namespace rapport
