#include "materials/table/measured_fields.h"
#include "tests/support/file_bytes.h"
#include "tests/support/gltf_writer.h"
#include "tests/support/measured_files.h"
#include "tests/support/synthetic_tables.h"

#include <cstdio>

// Writes the corpora that the fuzzers start from, a few kilobytes of sound files each, into
// FOLDER/bsdf, FOLDER/gltf, …

namespace rapport::tests {
namespace {

void bsdf_seeds(const std::filesystem::path& folder) {
    const auto dim = [](const IncidentDirection&, const glm::dvec3& out, size_t) {
        return 0.1 * std::abs(out.z);
    };
    BsdfTable table = small_synthetic_table(dim, 0.1);
    write_table(table, folder / "table.bsdf");
    write_table(small_synthetic_table(dim, 0, Bands::from_edges({400, 700})),
                folder / "spectral.bsdf");
    BsdfTable normal = make_partial_table(Bands{}, {{Side::front, 0, 0}, {Side::back, 0, 0}});
    normal.grid_theta = normal.grid_phi = {0};
    normal.grid_index = {0, 1};
    fill_table(normal, dim);
    write_table(normal, folder / "normal.bsdf");
    write_measured(small_measured(), folder / "measured.bsdf");
    MeasuredFields isotropic = small_measured(1);
    isotropic.wavelengths = {400, 500, 600};
    std::swap(isotropic.spectra, isotropic.rgb);
    write_measured(isotropic, folder / "isotropic.bsdf");
}

void gltf_seeds(const std::filesystem::path& folder) {
    GltfWriter file;
    const int positions =
        file.add_array(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, kFloat, "VEC3");
    const int uvs = file.add_array(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, kFloat, "VEC2");
    const int indices =
        file.add_array(std::vector<uint16_t>{0, 1, 2, 0, 2, 3}, kUnsignedShort, "SCALAR");
    file.add_mesh({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uvs}}},
                   {"indices", indices},
                   {"material", 0}});
    file.json["materials"] = {{{"name", "Body"}}};
    file.add_node({{"mesh", 0}, {"scale", {1, 2, 1}}, {"rotation", {0, 0, 0, 1}}});
    write_bytes(folder / "quad.glb", file.glb());
    write_bytes(folder / "quad.gltf", file.embedded());
    const int where = file.add_view(bytes_of(std::vector<uint8_t>{1, 2}));
    const int what = file.add_view(bytes_of(std::vector<uint16_t>{1, 2}));
    const int sparse = file.add_accessor(-1, kUnsignedShort, 6, "SCALAR");
    file.json["accessors"][size_t(sparse)]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", where}, {"componentType", kUnsignedByte}}},
        {"values", {{"bufferView", what}}}};
    file.json["meshes"][0]["primitives"][0]["indices"] = sparse;
    file.json["meshes"][0]["primitives"][0]["mode"] = 5;
    write_bytes(folder / "sparse.glb", file.glb());
    auto& primitive = file.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["COLOR_0"] = file.add_accessor(file.add_view(std::string(16, '\x80')),
                                                           kUnsignedByte, 4, "VEC4", 0, true);
    primitive["targets"] = {
        {{"COLOR_0", file.add_array(std::vector<float>(12, 0.25f), kFloat, "VEC3")}}};
    file.json["meshes"][0]["weights"] = {0.5};
    file.json["materials"] = {{{"alphaMode", "MASK"},
                               {"alphaCutoff", 0.3},
                               {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.5}}}}}};
    write_bytes(folder / "coloured.glb", file.glb());
    write_bytes(folder / "coloured.gltf", file.embedded());
}

void scene_seeds(const std::filesystem::path& folder) {
    write_bytes(folder / "all.pbrt",
                "Scale -1 1 1 LookAt 0 0 5 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 40\n"
                "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\n"
                "Sampler \"sobol\" \"integer pixelsamples\" 1\n"
                "Integrator \"path\" \"integer maxdepth\" 2\nWorldBegin # all\n"
                "LightSource \"infinite\" \"rgb L\" [1 1 1]\n"
                "LightSource \"distant\" \"point3 from\" [0 1 2] \"float scale\" 2\n"
                "AttributeBegin Rotate 30 0 0 1 Translate 1 2 3\n"
                "AreaLightSource \"diffuse\" \"rgb L\" [9 9 9] \"bool twosided\" true\n"
                "Material \"diffuse\" \"rgb reflectance\" [.5 .2 .1] ReverseOrientation\n"
                "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\n"
                "\"integer indices\" [0 1 2] \"point2 uv\" [0 0 1 0 0 1] AttributeEnd\n"
                "MakeNamedMaterial \"Body\" \"string type\" \"diffuse\" NamedMaterial \"Body\"\n"
                "CoordinateSystem \"here\" CoordSysTransform \"here\" Identity\n"
                "Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1]\n"
                "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]\n");
}

void wif_seeds(const std::filesystem::path& folder) {
    write_bytes(folder / "twill.wif",
                "[WIF]\nVersion=1.1\n[CONTENTS]\nWEAVING=yes\nWARP=yes\nWEFT=yes\nTHREADING=yes\n"
                "TIEUP=yes\nTREADLING=yes\n[WEAVING]\nShafts=4\nTreadles=4\nRising Shed=yes\n"
                "[WARP]\nThreads=4\n[WEFT]\nThreads=4\n[THREADING]\n1=1\n2=2\n3=3\n4=4\n"
                "[TIEUP]\n1=1,2\n2=2,3\n3=3,4\n4=4,1\n[TREADLING]\n1=1\n2=2\n3=3\n4=4\n");
    write_bytes(folder / "liftplan.wif",
                "[WIF]\nVersion=1.1\n[CONTENTS]\nWEAVING=yes\nWARP=yes\nWEFT=yes\nTHREADING=yes\n"
                "LIFTPLAN=yes\nCOLOR TABLE=yes\nWARP COLORS=yes\n[WEAVING]\nShafts=2\nTreadles=2\n"
                "[WARP]\nThreads=2\nColor=1\n[WEFT]\nThreads=2\nColor=2\n[COLOR TABLE]\n"
                "1=255,0,0\n2=0,0,9\n[WARP COLORS]\n2=2\n[THREADING]\n1=1\n2=2\n[LIFTPLAN]\n"
                "1=1\n2=2\n");
}

void cloth_seeds(const std::filesystem::path& folder) {
    for (const auto& entry : std::filesystem::directory_iterator(
             std::filesystem::path(RAPPORT_SOURCE_DIR) / "scenes/cloths"))
        if (entry.path().extension() == ".toml")
            write_bytes(folder / entry.path().filename(), read_bytes(entry.path()));
}

} // namespace
} // namespace rapport::tests

int main(int argc, char** argv) {
    using namespace rapport::tests;
    if (argc != 2) {
        std::fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
        return 2;
    }
    constexpr struct {
        const char* name;
        void (*write)(const std::filesystem::path& folder);
    } kCorpora[] = {{"bsdf", bsdf_seeds},
                    {"gltf", gltf_seeds},
                    {"scene", scene_seeds},
                    {"wif", wif_seeds},
                    {"cloth", cloth_seeds}};
    for (const auto& [name, write] : kCorpora) {
        const std::filesystem::path folder = std::filesystem::path(argv[1]) / name;
        std::filesystem::create_directories(folder);
        write(folder);
    }
    return 0;
}
