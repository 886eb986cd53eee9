// Wrong scene text: each case is refused with its place and with what would be right.
#include <gmock/gmock.h>

#include "unit/scene/scene_support.h"

namespace lampyr {
namespace {

struct Case {
  const char* name;
  std::string text;
  std::string message;
};

std::ostream& operator<<(std::ostream& stream, const Case& c) {
  return stream << c.text;
}

class SceneErrors : public testing::TestWithParam<Case> {};

TEST_P(SceneErrors, NameThePlaceAndTheRemedy) {
  EXPECT_EQ(ParseError(GetParam().text), GetParam().message);
}

std::string At(const char* place, const std::string& text) {
  return std::string("scene.pbrt:") + place + ": error: " + text;
}

const std::string kWorld = "WorldBegin\n";

INSTANTIATE_TEST_SUITE_P(
    Text, SceneErrors,
    testing::Values(
        Case{"UnterminatedString", kWorld + "  Shape \"sphere\n", At("2:9", "this string does not end on its line")},
        Case{"StringToEndOfFile", kWorld + "Shape \"sphere", At("2:7", "this string does not end on its line")},
        Case{"BadEscape", kWorld + "Shape \"a\\q\"",
             At("2:9", "a backslash that starts no escape; write \\\\ for a backslash itself")},
        Case{"EscapeAtEnd", kWorld + "Shape \"a\\",
             At("2:9", "a backslash that starts no escape; write \\\\ for a backslash itself")},
        Case{"NulInWord", kWorld + std::string("Sh\0pe", 5), At("2:3", "a NUL byte: this is not a text file")},
        Case{"NulInString", kWorld + std::string("Shape \"a\0\"", 10),
             At("2:9", "a NUL byte: this is not a text file")},
        Case{"NulInComment", kWorld + std::string("# a\0", 4), At("2:4", "a NUL byte: this is not a text file")},
        Case{"NotUtf8", kWorld + "Shape \"caf\xe9\"",
             At("2:11", "a byte that is not UTF-8; the file has to be saved as UTF-8")},
        Case{"OverlongUtf8", kWorld + "Shape \"\xc0\xaf\"",
             At("2:8", "a byte that is not UTF-8; the file has to be saved as UTF-8")},
        Case{"NotUtf8InList", kWorld + "Shape \"s\" \"float a\" [ 1\xff ]",
             At("2:24", "a byte that is not UTF-8; the file has to be saved as UTF-8")},
        Case{"Utf16", std::string("\xff\xfeW\0", 4), At("1:1", "the file is UTF-16; it has to be saved as UTF-8")},
        Case{"Empty", "", At("1:1", "the scene ends before WorldBegin: it describes no world")},
        Case{"OnlyOptions", "Film \"rgb\"\n# end\n",
             At("3:1", "the scene ends before WorldBegin: it describes no world")}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Statements, SceneErrors,
    testing::Values(
        Case{"Unknown", kWorld + "Shap \"sphere\"",
             At("2:1", "there is no statement \"Shap\" (did you mean \"Shape\"?)")},
        Case{"UnknownCase", "camera \"perspective\"",
             At("1:1", "there is no statement \"camera\" (did you mean \"Camera\"?)")},
        Case{"UnknownNothingNear", "Xyzzy", At("1:1", "there is no statement \"Xyzzy\"")},
        Case{"OfPbrt3", "Filter \"box\"",
             At("1:1", "there is no statement \"Filter\" (did you mean \"PixelFilter\"?)")},
        Case{"OfPbrt2", "SurfaceIntegrator \"path\"",
             At("1:1", "there is no statement \"SurfaceIntegrator\" (did you mean \"Integrator\"?)")},
        Case{"WorldBeforeWorldBegin", "\nShape \"sphere\"",
             At("2:1", "Shape describes the world: it must come after WorldBegin")},
        Case{"ImportBeforeWorldBegin", "Import \"x\"",
             At("1:1", "Import describes the world: it must come after WorldBegin")},
        Case{"OptionAfterWorldBegin", kWorld + "Camera \"perspective\"",
             At("2:1", "Camera must come before WorldBegin")},
        Case{"WorldBeginTwice", kWorld + " WorldBegin", At("2:2", "WorldBegin must come before WorldBegin")},
        Case{"TransformTimesInWorld", kWorld + "TransformTimes 0 1",
             At("2:1", "TransformTimes must come before WorldBegin")},
        Case{"NoType", kWorld + "Shape 3", At("2:7", "Shape needs a type in quotes, found the number \"3\"")},
        Case{"NoTypeAtEnd", kWorld + "Shape", At("2:6", "Shape needs a type in quotes, found the end of the file")},
        Case{"StrayString", kWorld + "\"sphere\"",
             At("2:1", "expected a statement, found the string \"sphere\"; WorldBegin takes no more")},
        Case{"StrayBracket", "[", At("1:1", "expected a statement, found \"[\"")},
        Case{"UnknownOption", "Option \"sed\" 3", At("1:8", "there is no option \"sed\" (did you mean \"seed\"?)")},
        Case{"OptionWithoutValue", "Option \"seed\"",
             At("1:14", "the option \"seed\" needs a value, found the end of the file")},
        Case{"UnknownColorSpace", "ColorSpace \"rec2002\"",
             At("1:12", "there is no colour space \"rec2002\" (did you mean \"rec2020\"?)")},
        Case{"UnknownAttributeTarget", kWorld + "Attribute \"shap\" \"float a\" 1",
             At("2:11", "there is no Attribute target \"shap\" (did you mean \"shape\"?)")},
        Case{"TextureOfColor", kWorld + "Texture \"t\" \"color\" \"imagemap\"",
             At("2:13", "a Texture is of \"float\" or \"spectrum\", not \"color\" (did you mean \"spectrum\"?)")},
        Case{"TextureTwice", kWorld + "Texture \"t\" \"float\" \"constant\"\nTexture \"t\" \"float\" \"constant\"",
             At("3:1", "the float texture \"t\" is defined twice")},
        Case{"MaterialTwice",
             kWorld + "MakeNamedMaterial \"m\" \"string type\" \"a\"\nMakeNamedMaterial \"m\" \"string type\" \"a\"",
             At("3:1", "the material \"m\" is defined twice; the first is at scene.pbrt:2:1")},
        Case{"MediumTwice", kWorld + "MakeNamedMedium \"m\" \"string type\" \"cloud\"\nMakeNamedMedium \"m\"",
             At("3:1", "the medium \"m\" is defined twice; the first is at scene.pbrt:2:1")},
        Case{"NamedMaterialWithoutType", kWorld + "MakeNamedMaterial \"m\"",
             At("2:1", "MakeNamedMaterial \"m\" needs a \"string type\"")},
        Case{"UnknownNamedMaterial",
             kWorld + "MakeNamedMaterial \"glass\" \"string type\" \"a\" NamedMaterial \"gloss\"",
             At("2:45", "there is no material \"gloss\" (did you mean \"glass\"?)")},
        Case{"UnknownMedium", kWorld + "MediumInterface \"fog\" \"\"", At("2:1", "there is no medium \"fog\"")}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Nesting, SceneErrors,
    testing::Values(
        Case{"EndWithoutBegin", kWorld + "AttributeEnd", At("2:1", "AttributeEnd without AttributeBegin")},
        Case{"BeginWithoutEnd", kWorld + "AttributeBegin\n AttributeBegin AttributeEnd",
             At("2:1", "this AttributeBegin has no AttributeEnd")},
        Case{"ObjectWithoutEnd", kWorld + "ObjectBegin \"a\"", At("2:1", "this ObjectBegin has no ObjectEnd")},
        Case{"TransformWithoutEnd", kWorld + "TransformBegin", At("2:1", "this TransformBegin has no TransformEnd")},
        Case{"ObjectEndWithoutBegin", kWorld + "ObjectEnd", At("2:1", "ObjectEnd without ObjectBegin")},
        Case{"AttributeEndsObject", kWorld + "ObjectBegin \"a\"\nAttributeEnd",
             At("3:1", "AttributeEnd ends the ObjectBegin at scene.pbrt:2:1")},
        Case{"ObjectEndsAttribute", kWorld + "ObjectBegin \"a\" AttributeBegin\nObjectEnd",
             At("3:1", "ObjectEnd ends the AttributeBegin at scene.pbrt:2:17")},
        Case{"NestedObject", kWorld + "ObjectBegin \"a\"\n ObjectBegin \"b\"",
             At("3:2", "ObjectBegin within the ObjectBegin at scene.pbrt:2:1")},
        Case{"ObjectTwice", kWorld + "ObjectBegin \"a\" ObjectEnd\nObjectBegin \"a\" ObjectEnd",
             At("3:1", "the object \"a\" is defined twice; the first is at scene.pbrt:2:1")},
        Case{"UnknownObject", kWorld + "ObjectBegin \"tree\" ObjectEnd\n  ObjectInstance \"tee\"",
             At("3:3", "there is no object \"tee\" (did you mean \"tree\"?)")},
        Case{"UnknownObjectInObject", kWorld + "ObjectBegin \"tree\" ObjectInstance \"leaf\" ObjectEnd",
             At("2:20", "there is no object \"leaf\"")},
        Case{"ObjectInItself", kWorld + "ObjectBegin \"a\" ObjectInstance \"a\" ObjectEnd",
             At("2:17", "an object that contains itself: \"a\" -> \"a\"")},
        Case{"ObjectsInEachOther",
             kWorld +
                 "ObjectBegin \"x\" ObjectInstance \"a\" ObjectEnd ObjectBegin \"a\" ObjectInstance \"b\" ObjectEnd\n"
                 "ObjectBegin \"b\" ObjectInstance \"a\" ObjectEnd",
             At("3:17", "an object that contains itself: \"a\" -> \"b\" -> \"a\"")}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Transforms, SceneErrors,
    testing::Values(
        Case{"TooFewNumbers", "Translate 1 2\nCamera \"perspective\"",
             At("2:1", "Translate needs 3 numbers, has 2 before \"Camera\"")},
        Case{"NumbersToTheEnd", "Scale 1", At("1:8", "Scale needs 3 numbers, has 1 before the end of the file")},
        Case{"TooManyNumbers", "Translate 1 2 3 4",
             At("1:17", "expected a statement, found the number \"4\"; Translate takes no more")},
        Case{"InBrackets", "Translate [ 1 2 3 ]", At("1:11", "Translate takes its numbers without brackets")},
        Case{"NoBrackets", "Transform 1 0 0 0",
             At("1:11", "Transform needs 16 numbers in brackets, found the number \"1\"")},
        Case{"MatrixTooShort", "ConcatTransform [ 1 0 0 0 ]",
             At("1:27", "ConcatTransform needs 16 numbers, has 4 before \"]\"")},
        Case{"MatrixTooLong", "Transform [ 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 5 ]",
             At("1:45", "Transform needs \"]\" after 16 numbers, found the number \"5\"")},
        Case{"ScaleZero", "  Scale 1 0 1 Camera \"perspective\"",
             At("1:3",
                "Scale makes the transform singular: it cannot be inverted, as Camera at scene.pbrt:1:15 needs it")},
        Case{"SingularMatrix", "Transform [ 1 2 3 0  2 4 6 0  0 0 1 0  0 0 0 1 ] CoordinateSystem \"a\"",
             At("1:1",
                "Transform makes the transform singular: it cannot be inverted, as CoordinateSystem at "
                "scene.pbrt:1:50 needs it")},
        Case{"SingularByRounding",
             "WorldBegin ConcatTransform [ .1 .2 .3 0  .7 1.4 2.1 0  0 0 1 0  0 0 0 1 ] LightSource \"point\"",
             At("1:12",
                "ConcatTransform makes the transform singular: it cannot be inverted, as LightSource at "
                "scene.pbrt:1:75 needs it")},
        Case{"TooSmall", "Scale 1e-38 1 1 Scale 1e-3 1 1",
             At("1:17", "Scale makes the transform too large or too small (beyond 3.4e38)")},
        Case{
            "Projective", "Transform [ 1 0 0 1  0 1 0 0  0 0 1 0  0 0 0 1 ]",
            At("1:1",
               "the matrix of Transform is not affine: its 4th, 8th and 12th numbers must be 0 and its 16th must not")},
        Case{"TooBig", "Scale 1e38 1 1 Scale 1e3 1 1",
             At("1:16", "Scale makes the transform too large or too small (beyond 3.4e38)")},
        Case{"Nan", "Translate 1 nan 2", At("1:13", "\"nan\" is not a finite number")},
        Case{"Infinite", "Translate 1 -Inf 2", At("1:13", "\"-Inf\" is not a finite number")},
        Case{"TooLarge", "Translate 1 1e999 2", At("1:13", "the number 1e999 is too large (at most 3.4e38)")},
        Case{"NotANumber", "Translate 1 1.2.3 2", At("1:13", "expected a number, found \"1.2.3\"")},
        Case{"Word", "Translate 1 x 2", At("1:13", "Translate needs 3 numbers, has 1 before \"x\"")},
        Case{"RotateAxis", "Rotate 30 0 0 0", At("1:1", "the axis of Rotate is (0, 0, 0)")},
        Case{"LookAtItself", "LookAt 1 2 3 1 2 3 0 1 0", At("1:1", "LookAt looks at the point it stands at")},
        Case{"LookAtNoUp", "LookAt 0 0 0 1 2 3 0 0 0", At("1:1", "the up vector of LookAt is (0, 0, 0)")},
        Case{"LookAtParallelUp", "LookAt 0 0 0 0 5 0 0 -1 0",
             At("1:1", "the up vector of LookAt is parallel to the direction of view")},
        Case{
            "ActiveTransformUnknown", "ActiveTransform StarTime",
            At("1:17", "ActiveTransform is All, StartTime or EndTime, not \"StarTime\" (did you mean \"StartTime\"?)")},
        Case{"TimesBackwards", "TransformTimes 1 0", At("1:1", "TransformTimes ends before it starts")}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Parameters, SceneErrors,
    testing::Values(Case{"UnknownType", kWorld + "Shape \"s\" \"flaot a\" 1",
                         At("2:11", "there is no parameter type \"flaot\" (did you mean \"float\"?)")},
                    Case{"TypeOfPbrt3", kWorld + "Shape \"s\" \"color Kd\" [ 1 1 1 ]",
                         At("2:11", "there is no parameter type \"color\" (did you mean \"rgb\"?)")},
                    Case{"PointOfPbrt3", kWorld + "Shape \"s\" \"point P\" [ 1 1 1 ]",
                         At("2:11", "there is no parameter type \"point\" (did you mean \"point3\"?)")},
                    Case{"NoName", kWorld + "Shape \"s\" \"radius\" 1",
                         At("2:11", "expected a parameter \"type name\", found the string \"radius\"")},
                    Case{"BlankDeclaration", kWorld + "Shape \"s\" \" \" 1",
                         At("2:11", "expected a parameter \"type name\", found the string \" \"")},
                    Case{"ThreeWords", kWorld + "Shape \"s\" \"float a b\" 1",
                         At("2:11", "a parameter is \"type name\", and the string \"float a b\" has more than that")},
                    Case{"TwoTypes", kWorld + "Shape \"s\" \"float a\" 1\n \"rgb a\" [ 2 2 2 ]",
                         At("3:2", "\"a\" is given twice, with two types; the first is at scene.pbrt:2:11")},
                    Case{"NoValue", kWorld + "Shape \"s\" \"float a\"\nShape \"s\"",
                         At("3:1", "expected a number, found \"Shape\"")},
                    Case{"NoValueAtEnd", kWorld + "Shape \"s\" \"float a\"",
                         At("2:20", "\"float a\": expected a number, found the end of the file")},
                    Case{"StringForFloat", kWorld + "Shape \"s\" \"float a\" [ 1 \"x\" ]",
                         At("2:25", "\"float a\": expected a number, found the string \"x\"")},
                    Case{"NumberForString", kWorld + "Shape \"s\" \"string a\" 3",
                         At("2:22", "\"string a\": expected a string, found the number \"3\"")},
                    Case{"NumberForBool", kWorld + "Shape \"s\" \"bool a\" 1",
                         At("2:20", "\"bool a\": expected true or false, found the number \"1\"")},
                    Case{"WordForBool", kWorld + "Shape \"s\" \"bool a\" \"yes\"",
                         At("2:20", "\"bool a\": expected true or false, found the string \"yes\"")},
                    Case{"FractionForInteger", kWorld + "Shape \"s\" \"integer a\" 3.5",
                         At("2:23", "expected integer, found \"3.5\"")},
                    Case{"FractionInIntegerList", kWorld + "Shape \"s\" \"integer a\" [ 1 3.5 ]",
                         At("2:27", "expected integer, found \"3.5\"")},
                    Case{"IntegerTooLarge", kWorld + "Shape \"s\" \"integer a\" [ 3000000000 ]",
                         At("2:25", "the integer 3000000000 does not fit 32 bits")},
                    Case{"NanInList", kWorld + "Shape \"s\" \"point3 P\" [ 0 0 nan ]",
                         At("2:28", "\"nan\" is not a finite number")},
                    Case{"MinusInfinityInList", kWorld + "Shape \"s\" \"float a\" [ -inf ]",
                         At("2:23", "\"-inf\" is not a finite number")},
                    Case{"ListWithoutEnd", kWorld + "Shape \"s\" \"float a\" [ 1 2\n",
                         At("2:21", "this list has no \"]\" before the end of the file")},
                    Case{"StatementInList", kWorld + "Shape \"s\" \"float a\" [ 1 2 Shape",
                         At("2:27", "expected a number, found \"Shape\"")},
                    Case{"ListInList", kWorld + "Shape \"s\" \"float a\" [ 1 [ 2 ] ]",
                         At("2:25", "\"float a\": expected a number, found \"[\"")},
                    Case{"MixedSpectrum", kWorld + "Shape \"s\" \"spectrum a\" [ 400 \"x\" ]",
                         At("2:30", "\"spectrum a\": expected a number, found the string \"x\"")},
                    Case{"NumberAfterSpectrumName", kWorld + "Shape \"s\" \"spectrum a\" [ \"x\" 400 ]",
                         At("2:30", "\"spectrum a\": expected a string, found the number \"400\"")}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace lampyr
