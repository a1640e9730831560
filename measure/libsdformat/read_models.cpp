// Prints the models that libsdformat reads from a file, one JSON object per line, with all poses in
// the frame of the model: read_models FILE [FOLDER OF MODELS ...]. Errors go to stderr, exit code 1.
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "sdf/sdf.hh"

using ignition::math::Pose3d;
using std::cout;

namespace {

std::string Quote(const std::string &_text) {
  std::ostringstream out;
  out << std::quoted(_text);
  return out.str();
}

void PrintNumbers(const std::vector<double> &_values) {
  cout << std::setprecision(17) << "[";
  for (size_t i = 0; i < _values.size(); ++i) {
    const double value = _values[i];
    cout << (i ? "," : "") << (std::isfinite(value) ? value : std::copysign(1e308, value));
  }
  cout << "]";
}

void PrintPose(const Pose3d &_pose) {
  const auto &p = _pose.Pos();
  const auto &q = _pose.Rot();
  PrintNumbers({p.X(), p.Y(), p.Z(), q.W(), q.X(), q.Y(), q.Z()});
}

void PrintShape(const sdf::Geometry *_shape) {
  std::string kind = "other";
  std::vector<double> size;
  if (const auto *box = _shape ? _shape->BoxShape() : nullptr) {
    kind = "box";
    size = {box->Size().X(), box->Size().Y(), box->Size().Z()};
  } else if (const auto *cylinder = _shape ? _shape->CylinderShape() : nullptr) {
    kind = "cylinder";
    size = {cylinder->Radius(), cylinder->Length()};
  } else if (const auto *capsule = _shape ? _shape->CapsuleShape() : nullptr) {
    kind = "capsule";
    size = {capsule->Radius(), capsule->Length()};
  } else if (const auto *sphere = _shape ? _shape->SphereShape() : nullptr) {
    kind = "sphere";
    size = {sphere->Radius()};
  } else if (const auto *ellipsoid = _shape ? _shape->EllipsoidShape() : nullptr) {
    kind = "ellipsoid";
    size = {ellipsoid->Radii().X(), ellipsoid->Radii().Y(), ellipsoid->Radii().Z()};
  } else if (const auto *mesh = _shape ? _shape->MeshShape() : nullptr) {
    kind = "mesh";
    size = {mesh->Scale().X(), mesh->Scale().Y(), mesh->Scale().Z()};
  } else if (_shape && _shape->PlaneShape()) {
    kind = "plane";
  }
  cout << "{\"kind\":\"" << kind << "\",\"size\":";
  PrintNumbers(size);
}

void PrintLink(const sdf::Link &_link, const std::string &_prefix, const Pose3d &_base) {
  Pose3d pose;
  _link.SemanticPose().Resolve(pose, "__model__");
  const auto &inertial = _link.Inertial();
  const auto moi = inertial.MassMatrix().Moi();
  cout << "{\"what\":\"link\",\"name\":" << Quote(_prefix + _link.Name()) << ",\"pose\":";
  PrintPose(_base * pose);
  cout << ",\"center\":";
  PrintPose(inertial.Pose());
  cout << ",\"mass\":";
  PrintNumbers({inertial.MassMatrix().Mass()});
  cout << ",\"tensor\":";
  PrintNumbers({moi(0, 0), moi(0, 1), moi(0, 2), moi(1, 1), moi(1, 2), moi(2, 2)});
  cout << ",\"visuals\":" << _link.VisualCount() << ",\"collisions\":[";
  for (uint64_t i = 0; i < _link.CollisionCount(); ++i) {
    const auto *collision = _link.CollisionByIndex(i);
    collision->SemanticPose().Resolve(pose);
    cout << (i ? "," : "");
    PrintShape(collision->Geom());
    cout << ",\"pose\":";
    PrintPose(pose);
    cout << "}";
  }
  cout << "]}\n";
}

void PrintJoint(const sdf::Joint &_joint, const std::string &_prefix, const Pose3d &_base) {
  static const char *kTypes[] = {"invalid",   "ball",     "continuous", "fixed", "gearbox",
                                 "prismatic", "revolute", "revolute2",  "screw", "universal"};
  std::string parent, child;
  Pose3d pose;
  _joint.ResolveParentLink(parent);
  _joint.ResolveChildLink(child);
  _joint.SemanticPose().Resolve(pose, "__model__");
  cout << "{\"what\":\"joint\",\"name\":" << Quote(_prefix + _joint.Name()) << ",\"type\":\""
       << kTypes[static_cast<int>(_joint.Type())] << "\",\"parent\":"
       << Quote(parent == "world" ? parent : _prefix + parent)
       << ",\"child\":" << Quote(_prefix + child) << ",\"pose\":";
  PrintPose(_base * pose);
  if (const auto *axis = _joint.Axis(0)) {
    ignition::math::Vector3d xyz;
    axis->ResolveXyz(xyz, "__model__");
    xyz = _base.Rot().RotateVector(xyz);
    cout << ",\"axis\":";
    PrintNumbers({xyz.X(), xyz.Y(), xyz.Z()});
    cout << ",\"limits\":";
    PrintNumbers({axis->Lower(), axis->Upper(), axis->Effort(), axis->MaxVelocity()});
    cout << ",\"dynamics\":";
    PrintNumbers({axis->Damping(), axis->Friction()});
  }
  cout << "}\n";
}

void PrintParts(const sdf::Model &_model, const std::string &_prefix, const Pose3d &_base) {
  for (uint64_t i = 0; i < _model.LinkCount(); ++i)
    PrintLink(*_model.LinkByIndex(i), _prefix, _base);
  for (uint64_t i = 0; i < _model.JointCount(); ++i)
    PrintJoint(*_model.JointByIndex(i), _prefix, _base);
  for (uint64_t i = 0; i < _model.ModelCount(); ++i) {
    Pose3d pose;
    const auto &nested = *_model.ModelByIndex(i);
    nested.SemanticPose().Resolve(pose, "__model__");
    PrintParts(nested, _prefix + nested.Name() + "::", _base * pose);
  }
}

void PrintModel(const sdf::Model &_model) {
  cout << "{\"what\":\"model\",\"name\":" << Quote(_model.Name()) << "}\n";
  PrintParts(_model, "", Pose3d::Zero);
}

}  // namespace

int main(int _count, char **_words) {
  std::vector<std::string> folders(_words + 2, _words + _count);
  auto config = sdf::ParserConfig::GlobalConfig();
  config.SetFindCallback([&](const std::string &_uri) -> std::string {
    const auto scheme = _uri.find("://");
    const auto path = scheme == std::string::npos ? _uri : _uri.substr(scheme + 3);
    if (std::filesystem::exists(path)) return path;
    for (const auto &folder : folders)
      if (std::filesystem::exists(folder + "/" + path)) return folder + "/" + path;
    return "";
  });
  sdf::Root root;
  const auto errors = root.Load(_words[1], config);
  for (const auto &error : errors) std::cerr << error.Message() << std::endl;
  if (root.Model()) PrintModel(*root.Model());
  for (uint64_t w = 0; w < root.WorldCount(); ++w)
    for (uint64_t i = 0; i < root.WorldByIndex(w)->ModelCount(); ++i)
      PrintModel(*root.WorldByIndex(w)->ModelByIndex(i));
  return errors.empty() ? 0 : 1;
}
