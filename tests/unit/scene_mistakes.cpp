// SPDX-License-Identifier: MIT
// Every mistake in a scene ends with one message: the place, what was expected, what there is.
#include <gtest/gtest.h>

#include <ostream>

#include "scene_files.h"

namespace h2mc::testing {
namespace {

struct Mistake {
  const char* name;
  std::string scene;
  std::vector<std::string> parts;  // of the message
};

std::ostream& operator<<(std::ostream& out, const Mistake& m) { return out << m.name; }

std::string shape(const std::string& inside) {
  return sceneWith("<shape type=\"sphere\">" + inside + "</shape>");
}
std::string bsdf(const std::string& inside) { return shape("<bsdf " + inside + "</bsdf>"); }

std::vector<Mistake> mistakes() {
  const std::string head = "<scene version=\"0.6.0\">\n";
  return {
      {"UnknownBsdf",
       bsdf("type=\"difuse\">"),
       {"scene.xml:2:34: error: unknown bsdf \"difuse\"\n", "\n  <shape", "\n         ",
        "did you mean \"diffuse\"?", "available: ", "roughconductor"}},
      {"UnknownShape",
       sceneWith("<shape type=\"ball\"/>"),
       {"scene.xml:2:14: error: unknown shape \"ball\"", "available: serialized, obj, ply"}},
      {"UnknownLight",
       sceneWith("<emitter type=\"skydome\"/>"),
       {"scene.xml:2:16: error: unknown emitter \"skydome\"", "point", "envmap"}},
      {"UnknownTexture",
       bsdf("type=\"diffuse\"><texture name=\"reflectance\" type=\"marble\"/>"),
       {"unknown texture \"marble\"", "checkerboard"}},
      {"UnknownSensor",
       head + "<sensor type=\"telecentric\"/></scene>",
       {"scene.xml:2:15: error: unknown sensor \"telecentric\"", "available: perspective"}},
      {"UnknownFilm",
       head + "<sensor type=\"perspective\"><film type=\"xfilm\"/></sensor></scene>",
       {"unknown film \"xfilm\"", "available: hdrfilm, ldrfilm"}},
      {"UnknownFilter",
       head + "<sensor type=\"perspective\"><film type=\"hdrfilm\"><rfilter type=\"lanczos\"/>"
              "</film></sensor></scene>",
       {"unknown reconstruction filter \"lanczos\"", "box, tent, gaussian, mitchell, catmullrom"}},
      {"NarrowBox",
       head + "<sensor type=\"perspective\"><film type=\"hdrfilm\"><rfilter type=\"box\">"
              "<float name=\"radius\" value=\"0.1\"/></rfilter></film></sensor></scene>",
       {"expected a number from 0.5 to 32"}},
      {"NarrowTent",
       head + "<sensor type=\"perspective\"><film type=\"hdrfilm\"><rfilter type=\"tent\">"
              "<float name=\"radius\" value=\"0.1\"/></rfilter></film></sensor></scene>",
       {"expected a number from 0.5 to 32"}},
      {"WideTent",
       head + "<sensor type=\"perspective\"><film type=\"hdrfilm\"><rfilter type=\"tent\">"
              "<float name=\"radius\" value=\"33\"/></rfilter></film></sensor></scene>",
       {"expected a number from 0.5 to 32"}},
      {"NarrowGaussian",
       head + "<sensor type=\"perspective\"><film type=\"hdrfilm\"><rfilter type=\"gaussian\">"
              "<float name=\"stddev\" value=\"1e-20\"/></rfilter></film></sensor></scene>",
       {"expected a number from 0.125 to 8"}},
      {"NegativeMitchell",
       head + "<sensor type=\"perspective\"><film type=\"hdrfilm\"><rfilter type=\"mitchell\">"
              "<float name=\"B\" value=\"1e20\"/></rfilter></film></sensor></scene>",
       {"expected a number from 0 to 1"}},
      {"MisspeltParameter",
       modern(bsdf("type=\"roughconductor\"><float name=\"alhpa\" value=\"0.1\"/>")),
       {"scene.xml:2:63: error: unknown parameter \"alhpa\" of bsdf \"roughconductor\"\n",
        "did you mean \"alpha\"?", "distribution"}},
      {"MisspeltShapeParameter",
       modern(shape("<float name=\"radus\" value=\"1\"/>")),
       {"unknown parameter \"radus\" of shape \"sphere\"", "did you mean \"radius\"?", "center"}},
      {"MisspeltIntegratorParameter",
       modern(sceneWith(
           "<integrator type=\"path\"><integer name=\"maxdept\" value=\"3\"/></integrator>")),
       {"scene.xml:2:40: error: unknown parameter \"maxdept\" of integrator \"path\"",
        "did you mean \"maxDepth\"?", "rrDepth"}},
      {"MisspeltDptParameter",
       sceneWith("<dpt><integer name=\"maxdeph\" value=\"3\"/></dpt>"),
       {"unknown parameter \"maxdeph\" of <dpt>", "did you mean \"maxdepth\"?"}},
      {"ParameterWithoutName",
       shape("<float value=\"1\"/>"),
       {"scene.xml:2:23: error: <float> inside shape \"sphere\" has no name", "radius"}},
      {"ParameterTwice",
       modern(shape("<float name=\"radius\" value=\"1\"/><float name=\"radius\" value=\"2\"/>")),
       {"scene.xml:2:67: error: parameter \"radius\" of shape \"sphere\" is given twice",
        "first at scene.xml:2:35"}},
      {"StringForNumber",
       shape("<string name=\"radius\" value=\"1\"/>"),
       {"scene.xml:2:23: error: parameter \"radius\" of shape \"sphere\" is a number, not a "
        "<string>",
        "expected <float name=\"radius\""}},
      {"FloatForInteger",
       sceneWith("<integrator type=\"path\"><float name=\"maxDepth\" value=\"3\"/></integrator>"),
       {"\"maxDepth\" of integrator \"path\" is not a <float>", "expected <integer"}},
      {"ColorForNumber",
       bsdf("type=\"phong\"><rgb name=\"exponent\" value=\"1,1,1\"/>"),
       {"\"exponent\" of bsdf \"phong\" is a", "not a <rgb>"}},
      {"NumberForBoolean",
       shape("<boolean name=\"flipNormals\" value=\"1\"/>"),
       {"scene.xml:2:57: error: \"1\" is neither true nor false"}},
      {"BadNumber",
       shape("<float name=\"radius\" value=\"1.2.3\"/>"),
       {"scene.xml:2:50: error: \"1.2.3\" is not a number", "expected <float name=\"radius\""}},
      {"EmptyNumber", shape("<float name=\"radius\" value=\"\"/>"), {"a number is missing"}},
      {"NotANumber",
       shape("<float name=\"radius\" value=\"nan\"/>"),
       {"\"nan\" is not a finite number"}},
      {"Infinite", shape("<float name=\"radius\" value=\"inf\"/>"), {"is not a finite number"}},
      {"TooLarge", shape("<float name=\"radius\" value=\"1e999\"/>"), {"is too large a number"}},
      {"TooLargeForFloat",
       shape("<float name=\"radius\" value=\"1e60\"/>"),
       {"too large a number"}},
      {"BadInteger",
       sceneWith(
           "<integrator type=\"path\"><integer name=\"maxDepth\" value=\"8x\"/></integrator>"),
       {"scene.xml:2:57: error: \"8x\" is not an integer"}},
      {"HugeInteger",
       sceneWith("<integrator type=\"path\"><integer name=\"maxDepth\" "
                 "value=\"99999999999\"/></integrator>"),
       {"too large an integer"}},
      {"NegativeRadius", shape("<float name=\"radius\" value=\"-1\"/>"), {"must be positive"}},
      {"NegativeColor",
       bsdf("type=\"diffuse\"><rgb name=\"reflectance\" value=\"0,-1,0\"/>"),
       {"a colour must not be negative"}},
      {"TwoNumbersOfAColor",
       bsdf("type=\"diffuse\"><rgb name=\"reflectance\" value=\"0,1\"/>"),
       {"a colour has 1 or 3 numbers, here are 2"}},
      {"BadHexColor",
       bsdf("type=\"diffuse\"><rgb name=\"reflectance\" value=\"#12345g\"/>"),
       {"\"#12345g\" is not a colour of the form #rrggbb"}},
      {"UnknownChoice",
       bsdf("type=\"roughconductor\"><string name=\"distribution\" value=\"gxx\"/>"),
       {"\"gxx\" is not a value of \"distribution\"", "did you mean \"ggx\"?", "beckmann"}},
      {"BadPoint",
       shape("<point name=\"center\" x=\"0\" y=\"a\" z=\"0\"/>"),
       {"scene.xml:2:52: error: \"a\" is not a number"}},
      {"MissingFile",
       sceneWith("<shape type=\"obj\"><string name=\"filename\" value=\"a.obj\"/></shape>"),
       {"scene.xml:2:50: error: no such file: \"a.obj\"", "looked in", "scene.xml"}},
      {"NoFile", sceneWith("<shape type=\"obj\"/>"), {"shape \"obj\" has no \"filename\""}},
      {"FileInNoFolder",
       sceneWith("<shape type=\"obj\"><string name=\"filename\" value=\"x/a.obj\"/></shape>"),
       {"no such file: \"x/a.obj\"", "there is no folder"}},
      {"UnknownId",
       sceneWith(
           "<bsdf type=\"diffuse\" id=\"red\"/><shape type=\"sphere\"><ref id=\"rde\"/></shape>"),
       {"scene.xml:2:62: error: nothing has the id \"rde\"", "did you mean \"red\"?"}},
      {"RefWithoutId", shape("<ref/>"), {"<ref> has no attribute \"id\""}},
      {"IdTwice",
       sceneWith("<bsdf type=\"diffuse\" id=\"a\"/>\n<bsdf type=\"diffuse\" id=\"a\"/>"),
       {"scene.xml:3:26: error: the id \"a\" is given twice", "first at scene.xml:2:26"}},
      {"RefToItself",
       sceneWith("<bsdf type=\"twosided\" id=\"a\"><ref id=\"a\"/></bsdf><shape "
                 "type=\"sphere\"><ref id=\"a\"/></shape>"),
       {"contains itself"}},
      {"RefToShape",
       shape("<ref id=\"s\"/>").replace(0, 24, head + "<shape type=\"disk\" id=\"s\"/>"),
       {"a reference to a shape inside shape \"sphere\""}},
      {"TwoBsdfs",
       shape("<bsdf type=\"diffuse\"/><bsdf type=\"diffuse\"/>"),
       {"scene.xml:2:45: error: shape \"sphere\" takes at most 1 bsdf"}},
      {"BsdfInDiffuse",
       bsdf("type=\"diffuse\"><bsdf type=\"diffuse\"/>"),
       {"<bsdf> inside bsdf \"diffuse\""}},
      {"EmptyTwosided", bsdf("type=\"twosided\">"), {"\"twosided\" without a bsdf inside"}},
      {"TwosidedGlass",
       bsdf("type=\"twosided\"><bsdf type=\"dielectric\"/>"),
       {"bsdf \"dielectric\" inside bsdf \"twosided\"", "does not let light through"}},
      {"TwosidedTwosided",
       bsdf("type=\"twosided\"><bsdf type=\"twosided\"><bsdf type=\"diffuse\"/></bsdf>"),
       {"bsdf \"twosided\" inside bsdf \"twosided\""}},
      {"TwosidedMask",
       bsdf("type=\"twosided\"><bsdf type=\"mask\"><float name=\"opacity\" value=\"0.5\"/>"
            "<bsdf type=\"diffuse\"/></bsdf>"),
       {"bsdf \"mask\" inside bsdf \"twosided\""}},
      {"EmptyMask", bsdf("type=\"mask\">"), {"\"mask\" without a bsdf inside"}},
      {"AreaWithoutShape",
       sceneWith("<emitter type=\"area\"/>"),
       {"emitter \"area\" is not on a shape", "expected it inside a <shape>"}},
      {"PointOnShape", shape("<emitter type=\"point\"/>"), {"emitter \"point\" on a shape"}},
      {"TwoEmittersOnShape",
       shape("<emitter type=\"area\"/><emitter type=\"area\"/>"),
       {"a second emitter on a shape"}},
      {"TwoSunsInOnePlace",
       sceneWith("<emitter type=\"sun\"/><emitter type=\"sun\"/>"),
       {"a second sun, which overlaps the first"}},
      {"NightSky",
       sceneWith("<emitter type=\"sky\"><float name=\"hour\" value=\"2\"/></emitter>"),
       {"degrees below the horizon"}},
      {"HazierThanTheModel",
       sceneWith("<emitter type=\"sunsky\"><float name=\"turbidity\" value=\"11\"/></emitter>"),
       {"turbidity", "11", "1 to 10"}},
      {"SunTwice",
       sceneWith("<emitter type=\"sun\"><vector name=\"sunDirection\" y=\"1\"/>"
                 "<integer name=\"year\" value=\"2011\"/></emitter>"),
       {"either sunDirection or place and time"}},
      {"InstanceOfNothing", sceneWith("<shape type=\"instance\"/>"), {"an instance of nothing"}},
      {"InstanceOfAShape",
       sceneWith("<shape type=\"cube\" id=\"c\"/><shape type=\"instance\"><ref id=\"c\"/></shape>"),
       {"an instance is of one shapegroup"}},
      {"LampInAGroup",
       sceneWith("<shape type=\"shapegroup\" id=\"g\"><shape type=\"cube\"><emitter type=\"area\"/>"
                 "</shape></shape><shape type=\"instance\"><ref id=\"g\"/></shape>"),
       {"an emitter inside a shapegroup"}},
      {"EmptyGroup",
       sceneWith(
           "<shape type=\"shapegroup\" id=\"g\"/><shape type=\"instance\"><ref id=\"g\"/></shape>"),
       {"a shapegroup without shapes"}},
      {"FlatInstance",
       sceneWith("<shape type=\"shapegroup\" id=\"g\"><shape type=\"cube\"/></shape>"
                 "<shape type=\"instance\"><ref id=\"g\"/><transform name=\"toWorld\">"
                 "<scale x=\"1\" y=\"1\" z=\"1e-9\"/></transform></shape>"),
       {"flattens the group"}},
      {"Medium",
       shape("<medium type=\"homogeneous\" name=\"interior\"/>"),
       {"media", "not supported"}},
      {"Flattened",
       shape("<transform name=\"toWorld\"><scale value=\"0\"/></transform>"),
       {"scene.xml:2:23: error: the transformation flattens space"}},
      {"UnknownTransformation",
       shape("<transform name=\"toWorld\"><rotat x=\"1\" angle=\"2\"/></transform>"),
       {"unknown transformation <rotat>", "did you mean \"rotate\"?", "translate"}},
      {"UnknownAttribute",
       shape("<transform name=\"toWorld\"><rotate w=\"1\" angle=\"2\"/></transform>"),
       {"unknown attribute \"w\" of <rotate>", "angle"}},
      {"RotateWithoutAngle",
       shape("<transform name=\"toWorld\"><rotate x=\"1\"/></transform>"),
       {"<rotate> has no attribute \"angle\""}},
      {"RotateWithoutAxis",
       shape("<transform name=\"toWorld\"><rotate angle=\"1\"/></transform>"),
       {"the axis of <rotate> is zero"}},
      {"ShortMatrix",
       shape("<transform name=\"toWorld\"><matrix value=\"1 2 3\"/></transform>"),
       {"a matrix has 16 numbers (or 9), here are 3"}},
      {"ProjectiveMatrix",
       shape("<transform name=\"toWorld\"><matrix value=\"1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 "
             "1\"/></transform>"),
       {"not affine"}},
      {"LookAtNowhere",
       shape("<transform name=\"toWorld\"><lookat origin=\"1,1,1\" target=\"1,1,1\" "
             "up=\"0,1,0\"/></transform>"),
       {"the same point"}},
      {"LookAlongUp",
       shape("<transform name=\"toWorld\"><lookat origin=\"0,0,0\" target=\"0,1,0\" "
             "up=\"0,1,0\"/></transform>"),
       {"up is parallel"}},
      {"TwoKeyframesAtOnce",
       shape("<animation name=\"toWorld\"><transform time=\"1\"/><transform time=\"1\">"
             "<translate x=\"1\"/></transform></animation>"),
       {"a second keyframe at the same time"}},
      {"NoCamera",
       head + kLight + kSphere + "</scene>",
       {"scene.xml:1:2: error: the scene has no camera", "<sensor type=\"perspective\">"}},
      {"NoLight",
       head + kCamera + kSphere + "</scene>",
       {"scene.xml:1:2: error: the scene has no light"}},
      {"BlackLight",
       head + kCamera + kSphere +
           "<emitter type=\"point\"><rgb name=\"intensity\" value=\"0\"/></emitter></scene>",
       {"the scene has no light"}},
      {"TwoCameras",
       head + kCamera + kCamera + "</scene>",
       {"scene.xml:4:2: error: a second camera", "first at scene.xml:2:2"}},
      {"FovOutOfRange",
       head + "<sensor type=\"perspective\"><float name=\"fov\" value=\"180\"/></sensor></scene>",
       {"\"fov\" is 180, expected a number from 0.0001 to 179.9"}},
      {"FovAxis",
       head +
           "<sensor type=\"perspective\"><string name=\"fovAxis\" value=\"z\"/></sensor></scene>",
       {"\"z\" is not a value of \"fovAxis\"", "x, y, diagonal, smaller, larger"}},
      {"ZeroWidth",
       head + "<sensor type=\"perspective\"><film type=\"hdrfilm\">"
              "<integer name=\"width\" value=\"0\"/></film></sensor></scene>",
       {"\"width\" is 0, expected a whole number from 1 to"}},
      {"HugeImage",
       head + "<sensor type=\"perspective\"><film type=\"hdrfilm\">"
              "<integer name=\"width\" value=\"2000000000\"/></film></sensor></scene>",
       {"the image would have 2000000000 x 576 pixels",
        "expected at most 65536 in width and height"}},
      {"Crop",
       head + "<sensor type=\"perspective\"><film type=\"hdrfilm\">"
              "<integer name=\"cropOffsetX\" value=\"8\"/><integer name=\"cropWidth\" "
              "value=\"761\"/></film></sensor></scene>",
       {"scene.xml:2:121: error: film \"hdrfilm\": the part rendered, 761 pixels from 8 on, is not "
        "within the film's "
        "768"}},
      {"ElementOfNoKind",
       sceneWith("<shap type=\"sphere\"/>"),
       {"scene.xml:2:2: error: <shap> inside <scene>", "did you mean \"shape\"?"}},
      {"WrongRoot", "<scenes/>", {"the outermost element is <scenes>"}},
      {"WrongVersion", "<scene version=\"new\"/>", {"\"new\" is not a version"}},
      {"UndefinedName",
       sceneWith("<default name=\"radius\" value=\"1\"/>\n<shape type=\"sphere\">"
                 "<float name=\"radius\" value=\"$radus\"/></shape>"),
       {"scene.xml:3:50: error: undefined name \"$radus\"", "did you mean \"radius\"?"}},
      {"TextBetween", modern(sceneWith("hello")), {"scene.xml:2:1: error: text inside <scene>"}},
      {"UnclosedElement", head + "<shape type=\"sphere\">", {"scene.xml:2:", "malformed XML"}},
      {"WrongEnd", "<scene></scen>", {"scene.xml:1:", "malformed XML"}},
      {"AttributeTwice",
       "<scene version=\"0.6.0\" version=\"0.6.0\"/>",
       {"attribute \"version\" is given twice"}},
      {"TwoRoots", "<scene/><scene/>", {"scene.xml:1:10: error: a second element"}},
      {"Empty", "", {"scene.xml:1:1: error: the file is empty"}},
      {"NoXml", "render this please", {"no XML element"}},
      {"Binary",
       std::string("\x7f"
                   "ELF\0\1\2",
                   7),
       {"not a text file"}},
      {"MissingInclude",
       "<scene>\n<include filename=\"other.xml\"/></scene>",
       {"scene.xml:2:20: error: no such file: \"other.xml\""}},
      {"IncludesItself",
       "<scene>\n<include filename=\"scene.xml\"/></scene>",
       {"scene.xml:2:20: error: ", "includes itself"}},
  };
}

class SceneMistake : public ::testing::TestWithParam<Mistake> {};

TEST_P(SceneMistake, HasOneMessageThatHelps) {
  const SceneFolder folder;
  const std::string message = folder.error(GetParam().scene);
  ASSERT_FALSE(message.empty()) << "the scene was read";
  for (const std::string& part : GetParam().parts)
    EXPECT_NE(message.find(part), std::string::npos) << "expected: " << part << "\nin: " << message;
  EXPECT_NE(message.find("scene.xml:"), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(All, SceneMistake, ::testing::ValuesIn(mistakes()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(SceneMistakeMessage, ShowsTheLineWithACaret) {
  const SceneFolder folder;
  const std::string message = folder.error(
      "<scene>\n\t<shape type=\"sphere\">\n\t\t<float name=\"radus\" "
      "value=\"1\"/>\n\t</shape>" +
      std::string(kCamera) + kLight + "</scene>");
  EXPECT_EQ(message,
            "scene.xml:3:16: error: unknown parameter \"radus\" of shape \"sphere\"\n"
            "    <float name=\"radus\" value=\"1\"/>\n"
            "                 ^\n"
            "expected a parameter that it has; did you mean \"radius\"? available: center, radius, "
            "toWorld, flipNormals");
}

TEST(SceneMistakeMessage, CutsLongLines) {
  const SceneFolder folder;
  const std::string filler(5000, ' ');
  const std::string message =
      folder.error("<scene>" + filler + "<shape type=\"bal\"/>" + filler + "</scene>");
  EXPECT_LT(message.size(), 600u);
  EXPECT_NE(message.find("scene.xml:1:5021: error: unknown shape \"bal\""), std::string::npos);
  EXPECT_NE(message.find("<shape type=\"bal\"/>"), std::string::npos);
}

TEST(SceneMistakeMessage, NamesTheIncludedFile) {
  const SceneFolder folder;
  folder.write("parts/bad.xml", "<scene>\n  <shape type=\"cone\"/>\n</scene>");
  const std::string message = folder.error("<scene><include filename=\"parts/bad.xml\"/></scene>");
  EXPECT_EQ(message.rfind("parts/bad.xml:2:16: error: unknown shape \"cone\"", 0), 0u) << message;
}

TEST(SceneMistakeMessage, UsesTheSpellingOfTheFilesVersion) {
  const SceneFolder folder;
  const std::string message = folder.error(
      "<scene version=\"3.0.0\"><shape type=\"sphere\"><float name=\"x\" "
      "value=\"1\"/></shape></scene>");
  EXPECT_NE(message.find("to_world, flip_normals"), std::string::npos) << message;
}

TEST(SceneMistakeMessage, NamesDefinesThatNothingUses) {
  const SceneFolder folder;
  ReadOptions options;
  options.defines = {{"widht", "3"}};
  const std::string message =
      folder.error(sceneWith("<default name=\"width\" value=\"8\"/>"), options);
  EXPECT_NE(message.find("the scene has no $widht"), std::string::npos) << message;
  EXPECT_NE(message.find("did you mean \"width\"?"), std::string::npos) << message;
}

TEST(SceneMistakeMessage, FileThatIsNotThere) {
  EXPECT_THROW(readScene("/no/such/scene.xml", {}), SceneError);
  EXPECT_THROW(readScene("/tmp", {}), SceneError);
}

TEST(SceneMistakeMessage, DeepNestingEnds) {
  const SceneFolder folder;
  std::string text = "<scene>";
  for (int i = 0; i < 100000; ++i) text += "<bsdf type=\"twosided\">";
  EXPECT_FALSE(folder.error(text).empty());
  for (int i = 0; i < 100000; ++i) text += "</bsdf>";
  EXPECT_NE(folder.error(text + "</scene>").find("nested more than"), std::string::npos);
}

TEST(SceneMistakeMessage, EveryTruncationOfASceneFails) {
  const SceneFolder folder;
  const std::string text = sceneWith("<bsdf type=\"diffuse\" id=\"a\"/>");
  const std::size_t whole = text.rfind('>');
  for (std::size_t length = 0; length <= whole; length += 3)
    EXPECT_FALSE(folder.error(text.substr(0, length)).empty()) << length;
}

}  // namespace
}  // namespace h2mc::testing
