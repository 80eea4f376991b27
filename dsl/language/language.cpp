// The language's tables, but for those of objects, shapes and cameras. A new key is one row here and one line
// where it is used.
#include "dsl/language/language.h"

#include "dsl/report/limits.h"

namespace patchlight {
namespace {

using enum ValueType;
using enum RuleKind;

constexpr KeyRow kSceneRows[] = {
    {"patchlight", kVersion, false, "", 1, kAnyInteger, "out-of-range", "",
     "Version of the language: 1. Required in the scene itself."},
    {"title", kText, false, "", 0, 0, "", "", "What the scene is called."},
    {"units", kChoice, false, "m", 0, 0, "bad-unit", "m|cm|mm|ft|in", "Unit of all lengths in the file."},
    {"let", kMap, false, "", 0, 0, "", "*", "Variables by name: numbers or expressions, in any order."},
    {"include", kIncludes, false, "", 0, 0, "", "include",
     "Files whose variables, materials and objects are added."},
    {"materials", kMap, false, "", 0, 0, "", "*material", "Materials by name."},
    {"objects", kList, false, "", 1, kAnyInteger, "", "object",
     "The things in the scene; one at least, here or in an included file."},
    {"sky", kMap, false, "", 0, 0, "", "sky", "The sky, infinitely far away. Absent: black."},
    {"sun", kMap, false, "", 0, 0, "", "sun", "The sun, a disc in the sky. Absent: none."},
    {"camera", kMap, false, "", 0, 0, "", "camera",
     "The camera, where one is enough. Absent: one that fits the scene."},
    {"cameras", kList, false, "", 0, 0, "", "camera", "Several cameras, each with a name."},
    {"solver", kMap, false, "", 0, 0, "", "solver", "How the light is computed."},
    {"output", kMap, false, "", 0, 0, "", "output", "What the pictures look like."},
    {"expect", kList, false, "", 0, 0, "", "expect",
     "Radiosities that `patchlight verify` compares the solution with."},
};
constexpr KeyRule kSceneRules[] = {
    {kExcludes, "camera", "cameras", "ambiguous-shape", "a scene has either 'camera' or 'cameras'"},
};

constexpr KeyRow kIncludeRows[] = {
    {"file", kText, true, "", 0, 0, "", "", "Path relative to this file, inside the scene's folder."},
    {"as", kName, false, "", 0, 0, "bad-name", "", "Prefix of its names: lamps makes white lamps.white."},
};

constexpr KeyRow kTransformRows[] = {
    {"translate", kVec3, false, "", -kAnyNumber, kAnyNumber, "out-of-range", "", "Shift by [x, y, z]."},
    {"rotate", kMap, false, "", 0, 0, "", "rotate", "Turn about an axis through the origin: {axis, angle}."},
    {"scale", kScale, false, "", 0, 0, "", "",
     "Stretch by a number or [x, y, z]; negative ones mirror, none is 0."},
};

constexpr std::string_view kOneStep = "a step of a transform is one of translate, rotate, scale";
constexpr KeyRule kTransformRules[] = {
    {kOneOf, "translate|rotate|scale", "", "missing-key", kOneStep},
    {kExcludes, "translate", "rotate|scale", "ambiguous-shape", kOneStep},
    {kExcludes, "rotate", "scale", "ambiguous-shape", kOneStep},
};

constexpr KeyRow kRotateRows[] = {
    {"axis", kAxis, true, "", 0, 0, "", "x|y|z", "Axis of the turn: x, y, z or a direction [x, y, z]."},
    {"angle", kNumber, true, "", -kAnyNumber, kAnyNumber, "out-of-range", "",
     "Degrees, counter-clockwise seen against the axis."},
};

constexpr KeyRow kExpectRows[] = {
    {"object", kText, true, "", 0, 0, "", "",
     "Id of an object or of one of its polygons, such as hall.floor: their area mean is compared."},
    {"pass", kInteger, false, "", 0, kPassesMax, "out-of-range", "",
     "After which pass. Absent: after the last one."},
    {"radiosity", kRgb, true, "", 0, kAnyNumber, "out-of-range", "",
     "What the solution should show, W/m2: a number or [r, g, b]."},
    {"tolerance", kNumber, false, "0.02", 0, 1, "out-of-range", "",
     "Allowed difference, as a share of the largest channel."},
};

constexpr KeyRow kMaterialRows[] = {
    {"reflectance", kRgb, false, "0", 0, 1, "reflectance-range", "",
     "Share of light that is reflected, 0..1: a number or [r, g, b]."},
    {"emission", kRgb, false, "0", 0, kEmissionMax, "emission-range", "",
     "Light given off: exitance in W/m2, which is radiance times pi; a number or [r, g, b]."},
    {"power", kRgb, false, "", 0, kEmissionMax, "emission-range", "",
     "Instead of emission, W: what all faces that an object has of this material give off together; a number "
     "or [r, g, b]."},
    {"temperature", kNumber, false, "", 0, kTemperatureMax, "out-of-range", "",
     "Beside emissivity, kelvin: the surface emits emissivity times 5.670374e-8 T^4 W/m2. Absent: nothing."},
    {"emissivity", kNumber, false, "", 0, 1, "out-of-range", "",
     "Heat in place of light, 0..1: the surface reflects 1 - emissivity."},
};
constexpr KeyRule kMaterialRules[] = {
    {kExcludes, "temperature|emissivity", "reflectance|emission|power", "ambiguous-material",
     "a material has either 'reflectance' and 'emission', or 'temperature' and 'emissivity'"},
    {kExcludes, "emission", "power", "ambiguous-material",
     "a material has either 'emission' (W/m2) or 'power' (W of each object that has it)"},
    {kNeeds, "temperature", "emissivity", "missing-key",
     "'temperature' wants 'emissivity' beside it; 1 is a black body"},
};

constexpr KeyRow kSkyRows[] = {
    {"kind", kChoice, false, "plain", 0, 0, "bad-name", "plain|overcast|clear",
     "plain, or how bright a standard sky is in each direction: overcast (CIE) or clear (Preetham)."},
    {"emission", kRgb, false, "", 0, kEmissionMax, "emission-range", "",
     "What a horizontal plane under the whole sky receives, W/m2 (overcast and clear: 100 unless said); of a "
     "plain sky the emission all over."},
    {"zenith", kRgb, false, "", 0, kEmissionMax, "emission-range", "",
     "Emission overhead, W/m2; from the horizon to there it grows with the sine of the elevation."},
    {"horizon", kRgb, false, "", 0, kEmissionMax, "emission-range", "",
     "Emission at the horizon, beside 'zenith', W/m2."},
    {"ground", kRgb, false, "0", 0, kEmissionMax, "emission-range", "",
     "Emission of what is seen below the horizon, W/m2."},
    {"turbidity", kNumber, false, "3", 2, 10, "out-of-range", "",
     "Haze of a clear sky: 2 is very clear, 10 hazy."},
};
constexpr KeyRule kSkyRules[] = {
    {kOneOf, "emission|zenith|horizon|kind", "", "missing-key",
     "a sky wants 'emission', or 'zenith' and 'horizon', or a 'kind'"},
    {kExcludes, "zenith|horizon", "emission", "ambiguous-sky",
     "a sky has either 'emission', or 'zenith' and 'horizon'"},
    {kNeeds, "zenith", "horizon", "missing-key", "'zenith' wants 'horizon' beside it"},
    {kNeeds, "horizon", "zenith", "missing-key", "'horizon' wants 'zenith' beside it"},
};

constexpr std::string_view kAzimuthText =
    "Degrees from north (-z) by way of east (x): clockwise seen from above.";
constexpr std::string_view kElevationText = "Degrees above the horizon.";
constexpr KeyRow kSunRows[] = {
    {"direction", kVec3OrMap, false, "", -kAnyNumber, kAnyNumber, "out-of-range", "sun_direction",
     "From the scene towards the sun: [0, 1, 0] is overhead; or {azimuth: 150, elevation: 40}."},
    {"azimuth", kNumber, false, "", -360, 360, "out-of-range", "", kAzimuthText},
    {"elevation", kNumber, false, "", -90, 90, "out-of-range", "", kElevationText},
    {"irradiance", kRgb, false, "", 0, kEmissionMax, "emission-range", "",
     "What it brings to a surface that faces it, W/m2: a number or [r, g, b]."},
    {"emission", kRgb, false, "", 0, kEmissionMax, "emission-range", "",
     "Instead: the exitance of its disc, W/m2."},
    {"angle", kNumber, false, "0.53", 0.01, 90, "out-of-range", "", "Its diameter, degrees."},
};
constexpr KeyRow kSunDirectionRows[] = {
    {"azimuth", kNumber, true, "", -360, 360, "out-of-range", "", kAzimuthText},
    {"elevation", kNumber, true, "", -90, 90, "out-of-range", "", kElevationText},
};
constexpr KeyRule kSunRules[] = {
    {kOneOf, "direction|elevation|azimuth", "", "missing-key",
     "a sun wants 'direction', or 'azimuth' and 'elevation'"},
    {kExcludes, "azimuth|elevation", "direction", "ambiguous-sky",
     "a sun has either 'direction', or 'azimuth' and 'elevation'"},
    {kNeeds, "azimuth", "elevation", "missing-key", "'azimuth' wants 'elevation' beside it"},
    {kNeeds, "elevation", "azimuth", "missing-key", "'elevation' wants 'azimuth' beside it"},
    {kOneOf, "irradiance|emission", "", "missing-key", "a sun wants 'irradiance' or 'emission'"},
    {kExcludes, "irradiance", "emission", "ambiguous-sky", "a sun has either 'irradiance' or 'emission'"},
};

constexpr KeyRow kSolverRows[] = {
    {"passes", kInteger, false, "16", 1, kPassesMax, "out-of-range", "", "At most so many passes (bounces)."},
    {"until", kNumber, false, "0.001", 0, 1, "out-of-range", "",
     "Stop when a pass adds less than this share of what pass 1 added; 0: never."},
    {"patch_size", kNumber, false, "", kAboveZero, kCoordinateMax, "out-of-range", "",
     "Longest edge of a starting patch. Absent: chosen from the scene's size."},
    {"patch_size_min", kNumber, false, "", kAboveZero, kCoordinateMax, "out-of-range", "",
     "Patches with a longest edge below this are not split. Absent: chosen from the scene's size."},
    {"threshold", kNumber, false, "0.1", 0, 1, "out-of-range", "",
     "Neighbours that differ by more than this share of the larger one are split."},
    {"max_patches", kInteger, false, "200000", 1, 1e9, "out-of-range", "", "The budget of patches."},
    {"rays", kInteger, false, "144", 1, 1e6, "out-of-range", "", "Rays a row of form factors."},
    {"error", kNumber, false, "0.01", kErrorMin, kErrorMax, "out-of-range", "",
     "What the light may be off by, mean over mean: less takes more rays and smaller patches."},
    {"quality", kNumber, false, "1", kQualityMin, kQualityMax, "out-of-range", "",
     "So many times the time that the error asked for would take, in more rays and smaller patches."},
    {"seed", kInteger, false, "1", 0, kAnyInteger, "out-of-range", "", "Another seed, other samples."},
};

constexpr KeyRow kOutputRows[] = {
    {"snapshots", kIntegers, false, "", 1, kPassesMax, "out-of-range", "",
     "Passes that are shown as pictures. Absent: 1, 2, 16, as far as they are run."},
    {"exposure", kNumberOrWord, false, "auto", -100, 100, "out-of-range", "auto",
     "auto, or an exposure value: shown is B times 2 to this power, 1 is white."},
    {"shading", kChoice, false, "smooth", 0, 0, "bad-name", "smooth|flat",
     "smooth, or flat to show the patches."},
    {"basename", kText, false, "", 0, 0, "", "",
     "First part of the files' names. Absent: the scene file's name."},
};

}  // namespace

const KeyTable kSceneKeys = {"scene", kSceneRows, kSceneRules};
const KeyTable kIncludeKeys = {"include", kIncludeRows};
const KeyTable kTransformKeys = {"transform", kTransformRows, kTransformRules};
const KeyTable kRotateKeys = {"rotate", kRotateRows};
const KeyTable kExpectKeys = {"expect", kExpectRows};
const KeyTable kMaterialKeys = {"material", kMaterialRows, kMaterialRules};
const KeyTable kSkyKeys = {"sky", kSkyRows, kSkyRules};
const KeyTable kSunKeys = {"sun", kSunRows, kSunRules};
const KeyTable kSunDirectionKeys = {"sun_direction", kSunDirectionRows};
const KeyTable kSolverKeys = {"solver", kSolverRows};
const KeyTable kOutputKeys = {"output", kOutputRows};

}  // namespace patchlight
