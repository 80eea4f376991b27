// The table of verbs.
#include "tools/verbs/verbs.h"

namespace patchlight {

// Two functions a verb, in the verb's own file; what render does stands in the folder render.
using Describe = void(Usage&, Options&);
using Run = int(const Options&, Talk&);
Describe describe_render, describe_view, describe_check, describe_verify, describe_show, describe_factors,
    describe_bench, describe_schema, describe_completion;
Run render, view, check, verify, show, factors, bench, print_schema, print_completion;

namespace {

constexpr Verb kVerbs[] = {
    {"render", "solve a scene, write pictures and a report", describe_render, render},
    {"view", "what does a patch see?", describe_view, view},
    {"check", "what is wrong with a scene, and what would it take?", describe_check, check},
    {"verify", "does the light come out as the scene expects?", describe_verify, verify},
    {"show", "which settings hold, and where each comes from", describe_show, show},
    {"factors", "form factors between the polygons of a scene", describe_factors, factors},
    {"bench", "how fast is it here?", describe_bench, bench},
    {"schema", "JSON Schema of the scene language, for editors", describe_schema, print_schema},
    {"completion", "completion for bash and zsh", describe_completion, print_completion},
};

}  // namespace

std::span<const Verb> verbs() { return kVerbs; }

}  // namespace patchlight
