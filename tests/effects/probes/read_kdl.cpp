// Prints the tree that kdl_parser makes of a URDF file, as JSON, on the last line of the output.
#include <kdl/tree.hpp>
#include <kdl_parser/kdl_parser.hpp>

#include <cmath>
#include <iostream>
#include <sstream>

static std::string number(double x) {
  if (!std::isfinite(x)) return std::isnan(x) ? "\"nan\"" : x > 0 ? "\"inf\"" : "\"-inf\"";
  std::ostringstream out;
  out.precision(9);
  out << x;
  return out.str();
}

int main(int, char **argv) {
  KDL::Tree tree;
  if (!kdl_parser::treeFromFile(argv[1], tree)) {
    std::cout << "\n{\"outcome\":\"rejects\"}" << std::endl;
    return 0;
  }
  std::ostringstream out;
  out << "{\"outcome\":\"loads\",\"moving\":" << tree.getNrOfJoints() << ",\"joints\":{";
  std::ostringstream links;
  bool first = true;
  for (auto &pair : tree.getSegments()) {
    if (pair.first == tree.getRootSegment()->first) continue;
    auto &segment = pair.second.segment;
    auto axis = segment.getJoint().JointAxis();
    bool fixed = segment.getJoint().getType() == KDL::Joint::None || segment.getJoint().getTypeName() == "None";
    out << (first ? "" : ",") << "\"" << segment.getJoint().getName() << "\":{\"type\":\"" << (fixed ? "fixed" : segment.getJoint().getTypeName())
        << "\",\"axis\":[" << number(axis.x()) << "," << number(axis.y()) << "," << number(axis.z()) << "]}";
    links << (first ? "" : ",") << "\"" << pair.first << "\":{\"mass\":" << number(segment.getInertia().getMass()) << ",\"inertia\":[";
    auto body = segment.getInertia();
    auto inertia = body.RefPoint(body.getCOG()).getRotationalInertia();
    static const int order[] = {0, 1, 2, 4, 5, 8};
    for (int k = 0; k < 6; ++k) links << (k ? "," : "") << number(inertia.data[order[k]]);
    links << "]}";
    first = false;
  }
  out << "},\"links\":{" << links.str() << "}}";
  std::cout << "\n" << out.str() << std::endl;
  return 0;
}
