#include "materials/table/bsdf_table.h"
#include "renderer/core/error.h"
#include "renderer/core/tensor_file.h"
#include "renderer/core/text_hash.h"

#include <Imath/half.h>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <numeric>

namespace rapport {
namespace {

using Type = TensorField::Type;
using Shape = std::vector<uint64_t>;

/// Light that is neither in a bin nor in one of the other shares may be this much: rounding of
/// float sums, not a lost path.
constexpr double kEnergyTolerance = 1e-3;
constexpr double kEdgeTolerance = 1e-12; // rounding, on other machines
constexpr double kAngleTolerance = 1e-6; // relative, of single precision

/// Raised whenever what the fields mean changes; files from before there was one count as 0.
constexpr uint32_t kFormat = 1;

template <class T> struct TypeOf;
template <> struct TypeOf<uint8_t> { static constexpr Type value = Type::u8; };
template <> struct TypeOf<uint32_t> { static constexpr Type value = Type::u32; };
template <> struct TypeOf<uint64_t> { static constexpr Type value = Type::u64; };
template <> struct TypeOf<Imath::half> { static constexpr Type value = Type::f16; };
template <> struct TypeOf<float> { static constexpr Type value = Type::f32; };
template <> struct TypeOf<double> { static constexpr Type value = Type::f64; };

std::string describe(Type type, const Shape& shape) {
    constexpr const char* kNames[] = {"?",   "u8",  "i8",  "u16", "i16", "u32",
                                      "i32", "u64", "i64", "f16", "f32", "f64"};
    const auto index = static_cast<size_t>(type);
    return fmt::format("{}[{}]", index < std::size(kNames) ? kNames[index] : "?",
                       fmt::join(shape, ", "));
}

/// Before the names of the fields of colourway number `i`.
std::string colourway_prefix(size_t i) { return fmt::format("colourway_{}_", i); }

/// [D, columns]: of the bins of a column, all of the same size.
std::vector<float> solid_angles(const BsdfTable& table) {
    std::vector<float> angles;
    for (size_t d = 0; d < table.directions(); ++d) {
        const ExitBins exits = table.exits_of(d);
        for (size_t bin = 0; bin < table.exits.bins(); bin += table.exits.rows())
            angles.push_back(static_cast<float>(exits.solid_angle(bin)));
    }
    return angles;
}

/// Turns the fields of one file into a table, or says what is wrong with which of them.
class Reader {
  public:
    /// The fields are those of the file at `path`, there or yet to be written, and outlive this.
    Reader(const std::filesystem::path& path, const TensorFile& fields)
        : path_(path.string()), fields_(fields) {}

    BsdfTable read() {
        text("description");
        read_format();
        read_bands();
        read_metadata();
        read_exits();
        read_incident();
        read_solid_angle();
        if (has("grid_theta") || has("grid_phi") || has("grid_index"))
            read_grid();
        read_scattering();
        return std::move(table_);
    }

    /// Of the fields that have been read: of their names, types, shapes and bytes.
    std::string checksum() const { return text_hash(digest_); }

    /// After all else: what is wrong with one field is told of that field.
    void check_checksum() {
        const std::string expected = checksum(), found = text("checksum");
        if (found != expected)
            fail("checksum", expected + " of the other fields", found);
    }

  private:
    [[noreturn]] void fail(const std::string& name, const std::string& expected,
                           const std::string& found) const {
        throw FileError(path_, name, expected, found);
    }

    bool has(const std::string& name) const { return fields_.contains(name); }

    /// Every field is read through here.
    const TensorField& field(const std::string& name, const std::string& expected) {
        const auto found = fields_.find(name);
        if (found == fields_.end())
            fail(name, expected, "no such field");
        const auto& [type, shape, bytes] = found->second;
        digest_ +=
            fmt::format("{} {} {}\n", name, describe(type, shape),
                        text_hash({reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
        return found->second;
    }

    template <class T> std::vector<T> array(const std::string& name, const Shape& shape) {
        const std::string expected = describe(TypeOf<T>::value, shape);
        const TensorField& stored = field(name, expected);
        if (stored.type != TypeOf<T>::value || stored.shape != shape)
            fail(name, expected, describe(stored.type, stored.shape));
        return stored.values<T>();
    }

    /// An array of one dimension whose length the file decides.
    template <class T> std::vector<T> list(const std::string& name) {
        const std::string expected = "a non-empty list of " + describe(TypeOf<T>::value, {});
        const TensorField& stored = field(name, expected);
        if (stored.type != TypeOf<T>::value || stored.shape.size() != 1 || stored.shape[0] == 0)
            fail(name, expected, describe(stored.type, stored.shape));
        return stored.values<T>();
    }

    std::string text(const std::string& name) {
        const TensorField& stored = field(name, "text");
        if (stored.type != Type::u8 || stored.shape.size() != 1)
            fail(name, "text", describe(stored.type, stored.shape));
        return stored.text();
    }

    nlohmann::json json(const std::string& name) {
        auto value = nlohmann::json::parse(text(name), nullptr, false);
        if (value.is_discarded())
            fail(name, "JSON", "text that is none");
        return value;
    }

    std::vector<std::string> names_in(const std::string& name) {
        const nlohmann::json names = json(name);
        const auto is_string = [](const nlohmann::json& v) { return v.is_string(); };
        if (!names.is_array() || names.empty() || !std::ranges::all_of(names, is_string))
            fail(name, "a JSON array of names", names.type_name());
        return names.get<std::vector<std::string>>();
    }

    void read_format() {
        const bool known = has("format");
        const uint32_t format = known ? array<uint32_t>("format", {1})[0] : 0;
        if (format != kFormat)
            fail("format", std::to_string(kFormat),
                 fmt::format("{}: measured by {} Rapport; measure it again",
                             known ? std::to_string(format) : "no such field",
                             format < kFormat ? "an older" : "a newer"));
    }

    void read_bands() {
        const std::vector<std::string> names = names_in("band_names");
        table_.bands.names = names;
        if (!has("band_edges_nm")) {
            if (table_.bands != Bands{})
                fail("band_names", "R, G, B where there is no band_edges_nm",
                     fmt::format("{}", fmt::join(table_.bands.names, ", ")));
            return;
        }
        table_.bands.edges_nm = array<double>("band_edges_nm", {names.size() + 1});
        check_axis("band_edges_nm", table_.bands.edges_nm, 0, HUGE_VAL);
    }

    void read_metadata() {
        const nlohmann::json metadata = json("metadata");
        if (!metadata.is_object())
            fail("metadata", "a JSON object", metadata.type_name());
        for (const auto& [key, value] : metadata.items()) {
            if (!value.is_string())
                fail("metadata." + key, "text", value.type_name());
            table_.metadata[key] = value.get<std::string>();
        }
        check_cloth_hash();
    }

    /// A text that JSON could not hold has a U+FFFD in it, and cannot be checked.
    void check_cloth_hash() const {
        const auto cloth = table_.metadata.find("cloth"), hash = table_.metadata.find("cloth_hash");
        if (cloth == table_.metadata.end() || hash == table_.metadata.end() ||
            cloth->second.find("\uFFFD") != std::string::npos)
            return;
        if (const std::string expected = text_hash(cloth->second); hash->second != expected)
            fail("metadata.cloth_hash", expected + " of its cloth", hash->second);
    }

    /// The mesh is known by how many columns and rows it has; the edges are there for others.
    void read_exits() {
        const auto u = list<double>("exit_u"), v = list<double>("exit_v");
        for (const auto& [name, edges] : {std::pair("exit_u", &u), {"exit_v", &v}})
            if ((edges == &u && edges->size() % 2 == 0) || edges->size() < 2 ||
                edges->size() > DirectionMesh::kMost + 1)
                fail(name,
                     fmt::format("the edges of {} up to {}",
                                 edges == &u ? "an even number of columns" : "rows",
                                 DirectionMesh::kMost),
                     fmt::format("{} edges", edges->size()));
        table_.exits =
            DirectionMesh(static_cast<int>(u.size()) - 1, static_cast<int>(v.size()) - 1);
        check_edges("exit_u", u, table_.exits.u_edges());
        check_edges("exit_v", v, table_.exits.v_edges());
        const auto axes = array<uint8_t>("exit_axis", {2});
        for (const size_t side : {0, 1}) {
            if (axes[side] > 1)
                fail(fmt::format("exit_axis[{}]", side), "0 (warp) or 1 (weft)",
                     std::to_string(axes[side]));
            table_.exit_axis[side] = static_cast<ConeAxis>(axes[side]);
        }
    }

    void check_edges(const std::string& name, const std::vector<double>& found,
                     const std::vector<double>& expected) const {
        for (size_t i = 0; i < found.size(); ++i)
            if (!(std::abs(found[i] - expected[i]) <= kEdgeTolerance))
                fail(fmt::format("{}[{}]", name, i), fmt::format("{}", expected[i]),
                     fmt::format("{}", found[i]));
    }

    void read_incident() {
        const auto theta = list<double>("incident_theta");
        const auto phi = array<double>("incident_phi", {theta.size()});
        const auto side = array<uint8_t>("incident_side", {theta.size()});
        for (size_t i = 0; i < theta.size(); ++i) {
            if (!(theta[i] >= 0 && theta[i] < kPi / 2))
                fail(fmt::format("incident_theta[{}]", i), "0 <= θ < π/2",
                     fmt::format("{}", theta[i]));
            if (!std::isfinite(phi[i]))
                fail(fmt::format("incident_phi[{}]", i), "a finite angle",
                     fmt::format("{}", phi[i]));
            if (side[i] > 1)
                fail(fmt::format("incident_side[{}]", i), "0 (front) or 1 (back)",
                     std::to_string(side[i]));
            table_.incident.push_back({static_cast<Side>(side[i]), theta[i], phi[i]});
        }
    }

    /// The chart decides; the angles are there for others.
    void read_solid_angle() {
        const auto found =
            array<float>("solid_angle", {table_.directions(), uint64_t(table_.exits.columns())});
        const std::vector<float> expected = solid_angles(table_);
        for (size_t i = 0; i < found.size(); ++i)
            if (!(std::abs(found[i] - expected[i]) <= kAngleTolerance * expected[i]))
                fail(fmt::format("solid_angle[{}]", i), fmt::format("{}", expected[i]),
                     fmt::format("{}", found[i]));
    }

    void check_axis(const std::string& name, const std::vector<double>& axis, double low,
                    double high) const {
        double previous = -HUGE_VAL;
        for (size_t i = 0; i < axis.size(); previous = axis[i++])
            if (!(axis[i] > previous && axis[i] >= low && axis[i] < high))
                fail(fmt::format("{}[{}]", name, i),
                     fmt::format("ascending numbers, {} <= x < {}", low, high),
                     fmt::format("{}", axis[i]));
    }

    void read_grid() {
        table_.grid_theta = list<double>("grid_theta");
        table_.grid_phi = list<double>("grid_phi");
        check_axis("grid_theta", table_.grid_theta, 0, kPi / 2);
        check_axis("grid_phi", table_.grid_phi, 0, 2 * kPi);
        if (table_.grid_phi[0] != 0)
            fail("grid_phi[0]", "0", fmt::format("{}", table_.grid_phi[0]));
        const size_t thetas = table_.grid_theta.size(), phis = table_.grid_phi.size();
        // All share one direction there: a small file would have nodes without bound.
        if (table_.grid_theta.back() == 0 && phis > 1)
            fail("grid_phi", "one φ where the only θ is 0", fmt::format("{}", phis));
        table_.grid_index = array<uint32_t>("grid_index", {2, thetas, phis});
        for (size_t i = 0; i < table_.grid_index.size(); ++i)
            check_grid_index(i, thetas * phis);
        if (std::ranges::count(table_.grid_index, BsdfTable::kAbsent) ==
            static_cast<ptrdiff_t>(table_.grid_index.size()))
            fail("grid_index", "at least one measured side", "none");
    }

    void check_grid_index(size_t i, size_t side_size) const {
        const uint32_t index = table_.grid_index[i];
        const std::string place = fmt::format("grid_index[{}]", i);
        const size_t side = i / side_size;
        const bool absent = table_.grid_index[side * side_size] == BsdfTable::kAbsent;
        if ((index == BsdfTable::kAbsent) != absent)
            fail(place, "a side that is measured wholly or not at all", std::to_string(index));
        if (absent)
            return;
        if (index >= table_.directions())
            fail(place, fmt::format("less than {}", table_.directions()), std::to_string(index));
        const double theta = table_.grid_theta[i % side_size / table_.grid_phi.size()];
        const double phi = table_.grid_phi[i % table_.grid_phi.size()];
        const IncidentDirection& incident = table_.incident[index];
        if (incident.side != static_cast<Side>(side) || incident.theta != theta ||
            (incident.phi != phi && theta != 0))
            fail(place, fmt::format("a direction on side {} at θ = {}, φ = {}", side, theta, phi),
                 fmt::format("side {}, θ = {}, φ = {}", static_cast<int>(incident.side),
                             incident.theta, incident.phi));
    }

    std::vector<float> shares(const std::string& name, const Shape& shape) {
        return finite(name, array<float>(name, shape));
    }

    /// In half or in single precision.
    std::vector<float> intensities(const std::string& name, const Shape& shape) {
        if (has(name) && fields_.at(name).type == Type::f32)
            return shares(name, shape);
        const auto halves = array<Imath::half>(name, shape);
        return finite(name, {halves.begin(), halves.end()});
    }

    std::vector<float> finite(const std::string& name, std::vector<float> values) const {
        for (size_t i = 0; i < values.size(); ++i)
            if (!(values[i] >= 0 && std::isfinite(values[i])))
                fail(fmt::format("{}[{}]", name, i), "a finite number >= 0",
                     fmt::format("{}", values[i]));
        return values;
    }

    void read_scattering() {
        table_.paths = array<uint64_t>("paths", {table_.directions()});
        if (has("colourways")) {
            const std::vector<std::string> names = names_in("colourways");
            for (size_t i = 0; i < names.size(); ++i) {
                read_shares(colourway_prefix(i));
                if (!table_.colourways.emplace(names[i], std::move(scattering())).second)
                    fail("colourways", "different names", "\"" + names[i] + "\" twice");
            }
        }
        read_shares("");
    }

    /// Those whose fields begin with `prefix`.
    void read_shares(const std::string& prefix) {
        const size_t directions = table_.directions(), bands = table_.bands.count();
        table_.intensity =
            intensities(prefix + "intensity", {directions, 2, table_.exits.bins(), bands});
        table_.unscattered = shares(prefix + "unscattered", {directions, bands});
        table_.absorbed = shares(prefix + "absorbed", {directions, bands});
        table_.capped = shares(prefix + "capped", {directions, bands});
        table_.lost = shares(prefix + "lost", {directions, bands});
        table_.accuracy = shares(prefix + "accuracy", {directions});
        table_.bin_error = shares(prefix + "bin_error", {directions});
        if (has("realisation_error"))
            table_.realisation_error = shares(prefix + "realisation_error", {directions});
        for (size_t d = 0; d < directions; ++d) {
            const auto reflected = table_.reflectance(d), transmitted = table_.transmittance(d);
            for (size_t band = 0; band < bands; ++band) {
                const size_t i = d * bands + band;
                const double sum = reflected[band] + transmitted[band] + table_.unscattered[i] +
                                   table_.absorbed[i] + table_.capped[i];
                if (!(std::abs(sum - 1) <= kEnergyTolerance))
                    fail(fmt::format("{}intensity[{}]", prefix, d),
                         fmt::format("shares of band {} that sum to 1", table_.bands.names[band]),
                         fmt::format("{:.6g}", sum));
            }
        }
    }

    Scattering& scattering() { return table_; }

    std::string path_;
    const TensorFile& fields_;
    std::string digest_;
    BsdfTable table_;
};

TensorField intensity_field(const Shape& shape, const std::vector<float>& values) {
    // Written so that what is not a number is written as it is, and refused.
    if (!std::ranges::all_of(values, [](float value) { return value <= HALF_MAX; }))
        return TensorField::of<float>(shape, values);
    return TensorField::of<Imath::half>(shape, {values.begin(), values.end()});
}

/// `scattering` is laid out as `table` is.
void add_scattering(TensorFile& fields, const std::string& prefix, const Scattering& scattering,
                    const BsdfTable& table) {
    const uint64_t directions = table.directions(), bands = table.bands.count();
    const auto add = [&](const char* name, const Shape& shape, const std::vector<float>& values) {
        fields[prefix + name] = TensorField::of<float>(shape, values);
    };
    fields[prefix + "intensity"] =
        intensity_field({directions, 2, table.exits.bins(), bands}, scattering.intensity);
    add("unscattered", {directions, bands}, scattering.unscattered);
    add("absorbed", {directions, bands}, scattering.absorbed);
    add("capped", {directions, bands}, scattering.capped);
    add("lost", {directions, bands}, scattering.lost);
    add("accuracy", {directions}, scattering.accuracy);
    add("bin_error", {directions}, scattering.bin_error);
    if (!scattering.realisation_error.empty())
        add("realisation_error", {directions}, scattering.realisation_error);
}

} // namespace

void write_table(const BsdfTable& table, const std::filesystem::path& path) {
    const DirectionMesh& mesh = table.exits;
    const uint64_t directions = table.directions(), bands = table.bands.count();
    std::vector<uint8_t> side;
    std::vector<double> theta, phi;
    for (const IncidentDirection& incident : table.incident) {
        side.push_back(static_cast<uint8_t>(incident.side));
        theta.push_back(incident.theta);
        phi.push_back(incident.phi);
    }

    const auto json_text = [](const nlohmann::json& value) {
        return TensorField::text(
            value.dump(1, ' ', false, nlohmann::json::error_handler_t::replace));
    };
    TensorFile fields;
    fields["description"] = TensorField::text("Rapport cloth BSDF table");
    fields["format"] = TensorField::of<uint32_t>({1}, {kFormat});
    fields["metadata"] = json_text(table.metadata);
    fields["band_names"] = json_text(table.bands.names);
    if (!table.bands.is_rgb())
        fields["band_edges_nm"] = TensorField::of<double>({bands + 1}, table.bands.edges_nm);
    fields["exit_u"] = TensorField::of<double>({mesh.u_edges().size()}, mesh.u_edges());
    fields["exit_v"] = TensorField::of<double>({mesh.v_edges().size()}, mesh.v_edges());
    fields["exit_axis"] = TensorField::of<uint8_t>(
        {2}, {static_cast<uint8_t>(table.exit_axis[0]), static_cast<uint8_t>(table.exit_axis[1])});
    fields["incident_side"] = TensorField::of<uint8_t>({directions}, side);
    fields["incident_theta"] = TensorField::of<double>({directions}, theta);
    fields["incident_phi"] = TensorField::of<double>({directions}, phi);
    fields["solid_angle"] =
        TensorField::of<float>({directions, uint64_t(mesh.columns())}, solid_angles(table));
    if (!table.partial()) {
        const uint64_t thetas = table.grid_theta.size(), phis = table.grid_phi.size();
        fields["grid_theta"] = TensorField::of<double>({thetas}, table.grid_theta);
        fields["grid_phi"] = TensorField::of<double>({phis}, table.grid_phi);
        fields["grid_index"] = TensorField::of<uint32_t>({2, thetas, phis}, table.grid_index);
    }
    add_scattering(fields, "", table, table);
    if (!table.colourways.empty()) {
        std::vector<std::string> names;
        for (const auto& [name, scattering] : table.colourways) {
            add_scattering(fields, colourway_prefix(names.size()), scattering, table);
            names.push_back(name);
        }
        fields["colourways"] = json_text(names);
    }
    fields["paths"] = TensorField::of<uint64_t>({directions}, table.paths);
    Reader reader(path, fields);
    reader.read();
    fields["checksum"] = TensorField::text(reader.checksum());
    write_tensor_file(fields, path);
}

BsdfTable table_of(const TensorFile& fields, const std::filesystem::path& path) {
    return Reader(path, fields).read();
}

BsdfTable read_table(const std::filesystem::path& path) {
    const TensorFile fields = read_tensor_file(path);
    Reader reader(path, fields);
    BsdfTable table = reader.read();
    reader.check_checksum();
    return table;
}

} // namespace rapport
