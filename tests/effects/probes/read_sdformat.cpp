// Prints the SDF that libsdformat makes of a URDF file, and its errors as "Error CODE: MESSAGE".
#include <iostream>

#include "sdf/sdf.hh"

int main(int, char **argv) {
  sdf::Root root;
  auto errors = root.Load(argv[1]);
  for (auto &error : errors)
    std::cerr << "Error " << static_cast<int>(error.Code()) << ": " << error.Message() << std::endl;
  std::cout << "---" << (errors.empty() ? "loads" : "rejects") << std::endl;
  if (root.Element()) std::cout << root.Element()->ToString("") << std::endl;
  return 0;
}
