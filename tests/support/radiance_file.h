#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

// Reads Radiance BSDF XML with TensorTree4 data by the rules of Radiance's own loader (bsdf_t.c:
// load_tree_data, SDlookupTre), written anew from them; stricter about what it does not expect.

namespace rapport::tests {

/// A tensor tree of rank 4: 16 subtrees, or a grid of 16^n values.
struct RadianceTree {
    std::vector<RadianceTree> branches;
    std::vector<float> grid;

    /// The value of the cell at a place in [0, 1)^4.
    float at(std::array<double, 4> place) const {
        if (!branches.empty()) {
            size_t branch = 0;
            for (size_t d = 0; d < 4; ++d) {
                place[d] *= 2;
                if (place[d] >= 1) {
                    place[d] -= 1;
                    branch |= size_t{1} << d;
                }
            }
            return branches[branch].at(place);
        }
        size_t side = 1;
        while (side * side * side * side < grid.size())
            side *= 2;
        size_t i = 0;
        for (const double p : place) // the last dimension fastest
            i = i * side + static_cast<size_t>(p * double(side));
        return grid.at(i);
    }

    static RadianceTree parse(const std::string& text) {
        size_t at = 0;
        RadianceTree tree = node(text, at);
        if (next(text, at) != '\0')
            throw std::runtime_error("extra characters after the tree");
        return tree;
    }

  private:
    static char next(const std::string& text, size_t& at) {
        while (at < text.size() && std::isspace(static_cast<unsigned char>(text[at])))
            ++at;
        return at < text.size() ? text[at] : '\0';
    }
    static void expect(const std::string& text, size_t& at, char c) {
        if (next(text, at) != c)
            throw std::runtime_error(std::string("expected ") + c);
        ++at;
    }
    static RadianceTree node(const std::string& text, size_t& at) {
        RadianceTree tree;
        expect(text, at, '{');
        if (next(text, at) == '{') {
            for (int i = 0; i < 16; ++i)
                tree.branches.push_back(node(text, at));
        } else {
            while (next(text, at) != '}') {
                size_t used = 0;
                tree.grid.push_back(std::stof(text.substr(at, 32), &used));
                at += used;
            }
            size_t power = 1;
            while (power < tree.grid.size())
                power *= 16;
            if (power != tree.grid.size())
                throw std::runtime_error("an illegal number of values");
        }
        expect(text, at, '}');
        return tree;
    }
};

/// The blocks by "wavelength direction", as in "Visible Transmission Back".
using RadianceBlocks = std::map<std::string, RadianceTree>;

/// What stands in the first element `tag` from `from` on; `from` moves behind it.
inline std::string element(const std::string& text, const std::string& tag, size_t& from) {
    const size_t open =
        std::min(text.find("<" + tag + ">", from), text.find("<" + tag + " ", from));
    const size_t start = text.find('>', open) + 1;
    const size_t end = text.find("</" + tag + ">", start);
    if (open == std::string::npos || end == std::string::npos)
        throw std::runtime_error("no <" + tag + ">");
    from = end + tag.size() + 3;
    return text.substr(start, end - start);
}
inline std::string element(const std::string& text, const std::string& tag) {
    size_t from = 0;
    return element(text, tag, from);
}

inline RadianceBlocks read_radiance(const std::string& text) {
    const std::string layer = element(element(element(text, "WindowElement"), "Optical"), "Layer");
    if (element(element(layer, "DataDefinition"), "IncidentDataStructure") != "TensorTree4")
        throw std::runtime_error("not a TensorTree4");
    RadianceBlocks blocks;
    for (size_t from = 0; layer.find("<WavelengthData>", from) != std::string::npos;) {
        const std::string data = element(layer, "WavelengthData", from);
        const std::string block = element(data, "WavelengthDataBlock");
        if (element(block, "AngleBasis") != "LBNL/Shirley-Chiu")
            throw std::runtime_error("another angle basis");
        blocks[element(data, "Wavelength") + ' ' + element(block, "WavelengthDataDirection")] =
            RadianceTree::parse(element(block, "ScatteringData"));
    }
    return blocks;
}

} // namespace rapport::tests
