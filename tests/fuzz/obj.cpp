// SPDX-License-Identifier: MIT
#include "fuzz_target.h"
#include "input_folder.h"
#include "mesh_promises.h"

namespace h2mc::fuzz {

void readInput(const std::string& input) {
  const std::string file = inputFolder().write("input.obj", input);
  checkMesh(loadObj(file, false));
  checkMesh(loadObj(file, true));
}

std::string mutateInput(const std::string& input, Random&, const ByteMutator& bytes,
                        std::size_t most) {
  return bytes(input, most);
}

std::span<const std::string_view> words() {
  static constexpr std::string_view kWords[] = {"v ",
                                                "vn ",
                                                "vt ",
                                                "f ",
                                                "o ",
                                                "g ",
                                                "s off\n",
                                                "usemtl ",
                                                "mtllib x.mtl\n",
                                                "#",
                                                "\\\n",
                                                "//",
                                                "/",
                                                "-1",
                                                "1/1/1",
                                                "\n",
                                                "\r\n",
                                                "l 1 2\n",
                                                "p 1\n",
                                                "f 1 2 3\n",
                                                "f -3 -2 -1\n",
                                                "f 1//1 2//2 3//3\n",
                                                "v 1e38 -1e38 0\n",
                                                "vt 0.5\n",
                                                "usemtl\n"};
  return kWords;
}

}  // namespace h2mc::fuzz
