#include "materials/table/tensor_tree.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <iterator>

namespace rapport {
namespace {

constexpr int kRank = 4, kParts = 1 << kRank;
using Corner = std::array<size_t, kRank>;

class Writer {
  public:
    Writer(std::vector<float>& values, int levels, float tolerance, float absolute)
        : values_(values), levels_(levels), tolerance_(tolerance), absolute_(absolute) {}

    std::string write(size_t& numbers) {
        const Node root = merge({}, levels_);
        numbers = 0;
        fmt::memory_buffer text;
        put(root, text, numbers);
        return fmt::to_string(text);
    }

  private:
    struct Node {
        float value = 0;
        std::vector<Node> parts; ///< none in a leaf
    };

    float& at(const Corner& corner) {
        size_t i = 0;
        for (const size_t c : corner)
            i = (i << levels_) + c;
        return values_[i];
    }

    /// The cube of side 2^level from `corner` on.
    Node merge(const Corner& corner, int level) {
        if (level == 0)
            return {at(corner), {}};
        Node node;
        float low = HUGE_VALF, high = 0, sum = 0;
        bool leaves = true;
        for (int part = 0; part < kParts; ++part) {
            Corner of_part = corner;
            for (int d = 0; d < kRank; ++d)
                if (part >> d & 1)
                    of_part[d] += size_t{1} << (level - 1);
            node.parts.push_back(merge(of_part, level - 1));
            const Node& made = node.parts.back();
            leaves = leaves && made.parts.empty();
            low = std::min(low, made.value);
            high = std::max(high, made.value);
            sum += made.value;
        }
        const float mean = sum / kParts;
        if (leaves && high - low <= tolerance_ * mean + absolute_) {
            fill(corner, level, mean);
            return {mean, {}};
        }
        return node;
    }

    void fill(const Corner& corner, int level, float value) {
        const size_t side = size_t{1} << level;
        for (size_t i = 0; i < side * side * side * side; ++i)
            at({corner[0] + (i >> 3 * level), corner[1] + (i >> 2 * level) % side,
                corner[2] + (i >> level) % side, corner[3] + i % side}) = value;
    }

    static void put(const Node& node, fmt::memory_buffer& text, size_t& numbers) {
        const auto put_value = [&](const Node& leaf) {
            fmt::format_to(std::back_inserter(text), " {:.4g}", leaf.value);
            ++numbers;
        };
        fmt::format_to(std::back_inserter(text), "{{");
        const bool branches =
            std::ranges::any_of(node.parts, [](const Node& part) { return !part.parts.empty(); });
        if (node.parts.empty()) {
            put_value(node);
        } else if (!branches) { // a grid: the last dimension fastest, where branches have the first
            for (int i = 0; i < kParts; ++i)
                put_value(node.parts[(i & 1) << 3 | (i & 2) << 1 | (i & 4) >> 1 | i >> 3]);
        } else {
            for (const Node& part : node.parts) {
                fmt::format_to(std::back_inserter(text), "\n");
                put(part, text, numbers);
            }
        }
        fmt::format_to(std::back_inserter(text), " }}");
    }

    std::vector<float>& values_;
    int levels_;
    float tolerance_, absolute_;
};

} // namespace

std::string tensor_tree(std::vector<float>& values, int levels, float tolerance, float absolute,
                        size_t& numbers) {
    return Writer(values, levels, tolerance, absolute).write(numbers);
}

} // namespace rapport
