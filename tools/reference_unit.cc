// Compiled by tools/test to learn how fast the machine compiles; no part of any program. To be left
// as it is: the budget of the build is told in multiples of its time.
#include <Eigen/Dense>
#include <algorithm>
#include <map>
#include <string>

Eigen::VectorXd solve(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  return a.fullPivLu().solve(b) + a.llt().solve(b);
}

std::string list(const std::map<std::string, double>& values) {
  std::string text;
  for (const auto& [name, value] : values) text += name + " " + std::to_string(value) + "\n";
  return text;
}
