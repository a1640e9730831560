// Prints what urdfdom makes of a URDF file, as JSON: one object, on the last line of the output.
#include <urdf_parser/urdf_parser.h>

#include <cmath>
#include <iostream>
#include <sstream>

static std::string text(const std::string &s) {
  std::ostringstream out;
  out << '"';
  for (unsigned char c : s) {
    if (c == '"' || c == '\\') out << '\\' << c;
    else if (c < 0x20) out << "\\u00" << "0123456789abcdef"[c >> 4] << "0123456789abcdef"[c & 15];
    else out << c;
  }
  out << '"';
  return out.str();
}

static std::string number(double x) {
  if (std::isnan(x)) return "\"nan\"";
  if (std::isinf(x)) return x > 0 ? "\"inf\"" : "\"-inf\"";
  std::ostringstream out;
  out.precision(9);
  out << x;
  return out.str();
}

static std::string vec(const urdf::Vector3 &v) {
  return "[" + number(v.x) + "," + number(v.y) + "," + number(v.z) + "]";
}

static std::string rpy(const urdf::Rotation &q) {
  double r, p, y;
  q.getRPY(r, p, y);
  return "[" + number(r) + "," + number(p) + "," + number(y) + "]";
}

static std::string shape(const urdf::GeometrySharedPtr &g) {
  if (!g) return "\"shape\":\"none\"";
  if (auto b = std::dynamic_pointer_cast<urdf::Box>(g)) return "\"shape\":\"box\",\"size\":" + vec(b->dim);
  if (auto c = std::dynamic_pointer_cast<urdf::Cylinder>(g))
    return "\"shape\":\"cylinder\",\"size\":[" + number(c->radius) + "," + number(c->length) + "]";
  if (auto s = std::dynamic_pointer_cast<urdf::Sphere>(g)) return "\"shape\":\"sphere\",\"size\":[" + number(s->radius) + "]";
  if (auto m = std::dynamic_pointer_cast<urdf::Mesh>(g))
    return "\"shape\":\"mesh\",\"file\":" + text(m->filename) + ",\"scale\":" + vec(m->scale);
  return "\"shape\":\"other\"";
}

int main(int, char **argv) {
  auto model = urdf::parseURDFFile(argv[1]);
  if (!model) {
    std::cout << "\n{\"outcome\":\"rejects\"}" << std::endl;
    return 0;
  }
  std::ostringstream out;
  out << "{\"outcome\":\"loads\",\"name\":" << text(model->getName()) << ",\"links\":{";
  bool first = true;
  for (auto &pair : model->links_) {
    auto link = pair.second;
    out << (first ? "" : ",") << text(pair.first) << ":{";
    first = false;
    if (link->inertial) {
      auto i = link->inertial;
      out << "\"mass\":" << number(i->mass) << ",\"com\":" << vec(i->origin.position) << ",\"inertia\":[" << number(i->ixx)
          << "," << number(i->ixy) << "," << number(i->ixz) << "," << number(i->iyy) << "," << number(i->iyz) << ","
          << number(i->izz) << "],";
    }
    out << "\"visuals\":[";
    for (size_t k = 0; k < link->visual_array.size(); ++k) {
      auto v = link->visual_array[k];
      out << (k ? "," : "") << "{" << shape(v->geometry) << ",\"xyz\":" << vec(v->origin.position)
          << ",\"rpy\":" << rpy(v->origin.rotation);
      if (!v->material_name.empty()) out << ",\"material\":" << text(v->material_name);
      if (v->material)
        out << ",\"color\":[" << v->material->color.r << "," << v->material->color.g << "," << v->material->color.b << ","
            << v->material->color.a << "]";
      out << "}";
    }
    out << "],\"collisions\":[";
    for (size_t k = 0; k < link->collision_array.size(); ++k) {
      auto c = link->collision_array[k];
      out << (k ? "," : "") << "{" << shape(c->geometry) << ",\"xyz\":" << vec(c->origin.position)
          << ",\"rpy\":" << rpy(c->origin.rotation) << "}";
    }
    out << "]}";
  }
  out << "},\"joints\":{";
  first = true;
  static const char *kinds[] = {"unknown", "revolute", "continuous", "prismatic", "floating", "planar", "fixed"};
  for (auto &pair : model->joints_) {
    auto j = pair.second;
    out << (first ? "" : ",") << text(pair.first) << ":{\"type\":\"" << kinds[j->type] << "\",\"parent\":" << text(j->parent_link_name)
        << ",\"child\":" << text(j->child_link_name) << ",\"xyz\":" << vec(j->parent_to_joint_origin_transform.position)
        << ",\"rpy\":" << rpy(j->parent_to_joint_origin_transform.rotation) << ",\"axis\":" << vec(j->axis);
    first = false;
    if (j->limits)
      out << ",\"lower\":" << number(j->limits->lower) << ",\"upper\":" << number(j->limits->upper)
          << ",\"effort\":" << number(j->limits->effort) << ",\"velocity\":" << number(j->limits->velocity);
    if (j->dynamics) out << ",\"damping\":" << number(j->dynamics->damping) << ",\"friction\":" << number(j->dynamics->friction);
    if (j->safety)
      out << ",\"soft\":[" << number(j->safety->soft_lower_limit) << "," << number(j->safety->soft_upper_limit) << ","
          << number(j->safety->k_position) << "," << number(j->safety->k_velocity) << "]";
    if (j->mimic)
      out << ",\"mimic\":{\"joint\":" << text(j->mimic->joint_name) << ",\"multiplier\":" << number(j->mimic->multiplier)
          << ",\"offset\":" << number(j->mimic->offset) << "}";
    out << "}";
  }
  out << "}}";
  std::cout << "\n" << out.str() << std::endl;
  return 0;
}
