#pragma once

#include "renderer/core/params.h"
#include "renderer/scene/pbrt/pbrt_lexer.h"

namespace rapport {

/// The `"type name" [values]` list that follows a directive, up to what is not a string. `owner`
/// names the directive in messages, `place` is its type or name.
Params read_pbrt_params(PbrtLexer& lexer, const std::string& owner, const PbrtToken& place);

} // namespace rapport
