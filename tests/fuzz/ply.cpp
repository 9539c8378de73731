// SPDX-License-Identifier: MIT
#include "fuzz_target.h"
#include "input_folder.h"
#include "mesh_promises.h"

namespace h2mc::fuzz {

void readInput(const std::string& input) {
  const std::string file = inputFolder().write("input.ply", input);
  checkMesh(loadPly(file, false));
  checkMesh(loadPly(file, true));
}

std::string mutateInput(const std::string& input, Random&, const ByteMutator& bytes,
                        std::size_t most) {
  return bytes(input, most);
}

std::span<const std::string_view> words() {
  static constexpr std::string_view kWords[] = {"ply\n",
                                                "format ascii 1.0\n",
                                                "format binary_little_endian 1.0\n",
                                                "format binary_big_endian 1.0\n",
                                                "comment x\n",
                                                "obj_info x\n",
                                                "element vertex ",
                                                "element face ",
                                                "element edge 1\n",
                                                "property float x\n",
                                                "property double y\n",
                                                "property float nx\n",
                                                "property float u\n",
                                                "property uchar red\n",
                                                "property int8 a\n",
                                                "property list uchar int vertex_indices\n",
                                                "property list uint uint vertex_index\n",
                                                "property list float double vertex_indices\n",
                                                "property list char short b\n",
                                                "end_header\n",
                                                "\n",
                                                "\r\n",
                                                "3 0 1 2\n",
                                                "4 0 1 2 3\n",
                                                "255 ",
                                                "-1 "};
  return kWords;
}

}  // namespace h2mc::fuzz
