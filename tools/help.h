// What --help says of each verb: what it does, examples first; the lists of flags follow.
#pragma once

namespace patchlight {

constexpr const char* kMainHelp =
    R"(patchlight turns a text scene of polygons into light (radiosity), pass by pass.

Examples:
  patchlight render room.yaml                       pictures after passes 1, 2 and 16 into out/
  patchlight render room.yaml -o lit --format png,exr,csv
  patchlight view room.yaml --from hall.floor@0.5,0.5     what a patch sees
  patchlight check room.yaml                        is the scene right, and what would it take?
  patchlight verify room.yaml                       does the light come out as the scene expects?
  patchlight show room.yaml --effective             which settings hold, and where each comes from
  patchlight factors room.yaml                      view factors between the polygons of a scene, as CSV
  patchlight render --help                          all flags of render
)";

constexpr const char* kRenderHelp = R"(Solves a scene and writes pictures, and a report, while it goes.

Examples:
  patchlight render room.yaml                       pictures after passes 1, 2 and 16 into out/
  patchlight render room.yaml --passes 4 --snapshots all --size 640x480
  patchlight render room.yaml -D w=8 --set solver.threshold=0.05
  patchlight render room.yaml --camera door --exposure -3.5 --mesh
  patchlight render room.yaml --storyboard --animation passes,rounds     for slides
  patchlight render room.yaml --false-color radiosity                    W/m2 as colours, with a legend
  patchlight render room.yaml --format exr,csv      numbers instead of pictures
  generate_scene | patchlight render - -o lit       a scene from standard input

Flags are stronger than the scene file. The paths of the files are the lines on standard output.
)";

constexpr const char* kViewHelp =
    R"(Shows what a patch sees: all directions before it in a circle, the normal in the middle, 90 degrees off it at the rim.

Examples:
  patchlight view room.yaml --from hall.floor@0.5,0.5
  patchlight view room.yaml --from 'pillars[0].2@0.5,0.8' --pass 0 --label    before any light is sent
  patchlight view room.yaml --from 'pillars[0].2@0.5,0.8' --pass 1 --label    and once direct light is there

u,v: 0..1 along the polygon's first edge and across, in the rectangle around it. Back sides are black.
)";

constexpr const char* kCheckHelp =
    R"(Reads a scene, says what is wrong with it, counts it and forecasts its memory; solves nothing.

Examples:
  patchlight check room.yaml
  patchlight check room.yaml --json                 the messages as a JSON list, for editors
)";

constexpr const char* kVerifyHelp =
    R"(Solves a scene and compares the light with what the scene says under `expect:`.

Examples:
  patchlight verify room.yaml                       exit code 0: as expected, 1: not so
  patchlight verify room.yaml --rays 1024           is a difference only noise?

In the scene:
  expect:
    - {object: hall.floor, pass: 16, radiosity: [1.2, 1.1, 0.9], tolerance: 0.02}

Compared are area means, after that pass; a run that converged earlier is compared as it stands at its end.
)";

constexpr const char* kShowHelp = R"(Shows what a scene means once everything is put together; solves nothing.

Examples:
  patchlight show room.yaml --effective             every setting with its origin
  patchlight show room.yaml --effective -D w=8 --set solver.rays=64 --passes 4

Origins, the weaker first: built-in, FILE:LINE:COLUMN, -D and --set, other flags.
)";

constexpr const char* kSchemaHelp =
    R"(Prints the JSON Schema (draft-07) of the scene language, made from the tables that scenes are read by.

Examples:
  patchlight schema > patchlight.schema.json        for editors; in a scene's first line:
  # yaml-language-server: $schema=./patchlight.schema.json
)";

constexpr const char* kCompletionHelp =
    R"(Prints what makes a shell complete verbs, flags and their values.

Examples:
  source <(patchlight completion bash)              bash: here and now; in ~/.bashrc: always
  patchlight completion zsh > ~/.zfunc/_patchlight  zsh: in a folder of $fpath, before compinit
)";

constexpr const char* kFactorsHelp =
    R"(Prints the form factors (view factors) between the polygons of a scene: a row a polygon, with its area, the
factors to all polygons in the order of the scene, and their sum, which is not adjusted.

Examples:
  patchlight factors duct.yaml > duct.csv
  patchlight factors duct.yaml --format json        with an estimated error beside every factor
  patchlight factors duct.yaml --error 1e-4         more rays where something stands between polygons
  patchlight factors duct.yaml -D gap=0.02          a variable of the scene

Factors between polygons with nothing in between are exact (1e-6) and need no rays.
)";

constexpr const char* kBenchHelp =
    R"(Measures this build on this machine: kernels beside bare Embree and bare memory, and whole runs of scenes.

Examples:
  patchlight bench                                  kernels, and the scenes of the folder scenes
  patchlight bench room.yaml --only scenes          whole runs of one scene
  patchlight bench --only loading                   large scenes, beside the YAML parser alone
  patchlight bench --only growth,threads --json b.json

Every figure is a median with its lowest and highest value. Kernels, growth and threads take the first scene.
)";

}  // namespace patchlight
