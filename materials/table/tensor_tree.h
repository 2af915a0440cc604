#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace rapport {

/// Text of a Radiance tensor tree of rank 4 from values on a grid of 2^levels cells a side, the
/// last dimension fastest; `values` receives the merged cells. A branch is a list of 16 subtrees
/// whose number has bit d set in the upper half of dimension d; leaves are lists of 1 or 16 values,
/// the last dimension fastest. The 16 parts of a cube become one where they differ by no more than
/// `tolerance` of their mean plus `absolute`; their mean is kept.
std::string tensor_tree(std::vector<float>& values, int levels, float tolerance, float absolute,
                        size_t& numbers);

} // namespace rapport
