// A scene as described by its file: plain data in double precision. Nothing is built, and no file but the scene's own
// (and its includes) is opened. Every part holds its location in the file.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "math/transform.h"
#include "scene/parameters.h"

namespace lampyr {

struct MotionTimes;

// Transforms from local to world space at the start and the end of the transform times, equal without motion.
struct Placement {
  Transform start, end;
  bool IsAnimated() const { return !(start == end); }
};

// A statement such as `Camera "perspective" …`: its type and parameters. The type is empty if the statement was not
// given.
struct StatementDescription {
  std::string type;
  ParameterList parameters;
  FileLocation where;

  // A name for an object without one: "sphere scene.pbrt:12:3".
  std::string NameByPlace() const {
    const std::string file = where.file ? std::filesystem::path(*where.file).filename().string() : "";
    return type + " " + file + ":" + std::to_string(where.line) + ":" + std::to_string(where.column);
  }
};

struct NamedMaterialDescription {
  std::string name;
  StatementDescription material;  // type from "string type"
};

struct TextureDescription {
  std::string name;
  bool isSpectrum = false;       // colour, not float
  StatementDescription texture;  // type: "imagemap", "scale", …
  Placement placement;
};

// A named participating medium. The type is that of its parameter "type".
struct MediumDescription {
  std::string name;
  StatementDescription medium;
  Placement placement;  // from the medium's space to world space
};

struct LightFilterDescription {
  StatementDescription filter;
  Placement placement;  // of its own coordinate system, or of the named one
};

struct LightDescription {
  StatementDescription light;
  Placement placement;
  std::string mediumName;  // outside medium
  int filter = -1;         // index into lightFilters, -1 none
};

struct AreaLightDescription : StatementDescription {
  int filter = -1;  // index into lightFilters, -1 none
};

// Reference to a material: an index into `materials`, or a name among `namedMaterials`.
struct MaterialReference {
  int index = -1;
  std::string name;
  FileLocation where;
};

struct ShapeDescription {
  StatementDescription shape;
  Placement placement;
  bool reverseOrientation = false;
  MaterialReference material;
  int areaLight = -1;  // index into areaLights, -1 none
  std::string insideMedium, outsideMedium;
  // Attributes in force by target ("shape", "lightfilter", "lighting", …) that are not parameters of the shape itself.
  std::map<std::string, ParameterList> attributes;
};

struct ObjectDescription {
  std::string name;
  FileLocation where;
  std::vector<ShapeDescription> shapes;
  std::vector<struct InstanceDescription> instances;  // of other objects, in this one
};

struct InstanceDescription {
  std::string object;
  FileLocation where;
  Placement placement;
};

// A shared library with types that the scene uses: a file relative to the scene, or a name to be searched for.
struct PluginReference {
  std::string name;
  FileLocation where;
};

struct SceneDescription {
  std::filesystem::path file;
  std::string contentHash;         // of all text read, hexadecimal
  std::vector<std::string> files;  // the main file and those it includes

  StatementDescription camera, film, pixelFilter, sampler, integrator, accelerator;
  Placement cameraToWorld;
  std::string cameraMedium;                  // name of the medium around the camera; "": none
  double shutterOpen = 0, shutterClose = 1;  // TransformTimes
  std::map<std::string, Parameter> options;
  std::vector<PluginReference> plugins;  // Option "plugins"

  std::vector<StatementDescription> materials;
  std::vector<NamedMaterialDescription> namedMaterials;
  std::vector<TextureDescription> textures;
  std::vector<MediumDescription> media;
  std::vector<LightFilterDescription> lightFilters;  // except those of type "none"
  std::vector<AreaLightDescription> areaLights;
  std::vector<LightDescription> lights;
  std::vector<ShapeDescription> shapes;
  std::vector<ObjectDescription> objects;
  std::vector<InstanceDescription> instances;
  double instanceCount = 0;  // including those nested in objects
};

// The transform times, as fractions of the time that the camera's shutter is open. Throws an Error.
MotionTimes MotionTimesOf(const SceneDescription& description);

// Reads a scene file (plain or gzipped) and its includes. Throws an Error with file, line and column; warnings go to
// `diagnostics`.
SceneDescription ReadScene(const std::filesystem::path& file, Diagnostics& diagnostics);

// Reads a scene from text in memory. `name` stands for the file in messages; relative file names are resolved against
// its folder.
SceneDescription ParseScene(const std::string& text, const std::filesystem::path& name, Diagnostics& diagnostics);

}  // namespace lampyr
