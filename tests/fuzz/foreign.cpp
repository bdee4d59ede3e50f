// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0

// Readers of `validate` for files of others: XML, URDF, SDF, MJCF, USD, glTF, and meshes as they
// are.

#include <array>

#include "doorforge/core/error.h"
#include "doorforge/schemas/usda_text.h"

#include "fuzz_target.h"
#include "input_folder.h"
#include "read/glb_file.h"
#include "read/raw_mesh.h"
#include "read/readers.h"
#include "text/xml_text.h"

namespace doorforge::fuzz {
namespace {

using namespace doorforge::foreign;

/// A fault of the text is an answer.
template <class Read>
void Answered(Read&& read) {
  try {
    read();
  } catch (const RawMeshFault&) {
  } catch (const UsdaFault&) {
  } catch (const XmlFault&) {
  }
}

void ReadXmlText(std::string_view input) {
  Answered([&] {
    const XmlDocument document = ParseXml(input);
    for (const XmlElement& element : document.elements) XPathOf(element);
  });
}

template <class Read>
void ReadXmlModel(std::string_view input, Read&& read) {
  FaultList faults;
  Answered([&] { read(ParseXml(input), faults); });
  faults.Sorted();
}

void ReadUrdfObject(std::string_view input) {
  ReadXmlModel(input, [](const XmlDocument& document, FaultList& faults) {
    ReadForeignUrdf(document, "input", faults);
  });
}

void ReadSdfObject(std::string_view input) {
  ReadXmlModel(input, [](const XmlDocument& document, FaultList& faults) {
    ReadForeignSdf(document, "input", faults);
  });
}

void ReadMjcfObject(std::string_view input) {
  static const auto folder = InputFile("nothing", "").parent_path();
  ReadXmlModel(input, [](const XmlDocument& document, FaultList& faults) {
    ReadForeignMjcf(document, (folder / "input.xml").string(), folder, faults);
  });
}

void ReadUsda(std::string_view input) {
  FaultList faults;
  Answered([&] { ReadForeignUsda(input, "input", faults); });
  faults.Sorted();
}

void ReadGltf(std::string_view input) {
  FaultList faults;
  Answered([&] {
    CheckGltf(
        input, "input", [](const ForeignFileName&) { return std::nullopt; }, faults);
  });
  Answered([&] { GlbTriangles(input); });
}

void CheckTriangles(const TriangleMesh& mesh) {
  for (const Eigen::Vector3i& triangle : mesh.triangles)
    Expect(triangle.minCoeff() >= 0 && triangle.maxCoeff() < static_cast<int>(mesh.vertices.size()),
           "a triangle's corners are there");
}

void ReadRaw(std::string_view input, TriangleMesh (*read)(std::string_view)) {
  Answered([&] { CheckTriangles(read(input)); });
}

void ReadObjAsItIs(std::string_view input) {
  std::vector<ForeignFileName> files;
  Answered([&] { CheckTriangles(ReadRawObj(input, "input", files)); });
}

void ReadStlAsItIs(std::string_view input) { ReadRaw(input, ReadRawStl); }
void ReadPlyAsItIs(std::string_view input) { ReadRaw(input, ReadRawPly); }
void ReadOffAsItIs(std::string_view input) { ReadRaw(input, ReadRawOff); }

constexpr std::array kTargets{
    Target{"xml", Shape::kBytes, ReadXmlText},
    Target{"foreign_urdf", Shape::kBytes, ReadUrdfObject},
    Target{"foreign_sdf", Shape::kBytes, ReadSdfObject},
    Target{"foreign_mjcf", Shape::kBytes, ReadMjcfObject},
    Target{"usda", Shape::kBytes, ReadUsda},
    Target{"gltf", Shape::kGlb, ReadGltf},
    Target{"raw_obj", Shape::kBytes, ReadObjAsItIs},
    Target{"raw_stl", Shape::kBytes, ReadStlAsItIs},
    Target{"raw_ply", Shape::kBytes, ReadPlyAsItIs},
    Target{"raw_off", Shape::kBytes, ReadOffAsItIs},
};

}  // namespace

std::span<const Target> Targets() { return kTargets; }

}  // namespace doorforge::fuzz
