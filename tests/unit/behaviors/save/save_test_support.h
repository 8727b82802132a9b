// Behaviors in files of a scratch folder, with values saved into them.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "behaviors/save/values.h"
#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {

class SaveTest : public testing::Test {
 protected:
  SaveTest() { std::filesystem::create_directories(folder_); }
  ~SaveTest() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  void put(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(file(name), std::ios::binary) << text;
  }
  std::string get(const std::string& name) const {
    std::ifstream in(file(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  behaviors::SavePlan plan(const std::string& name,
                           const std::vector<behaviors::NamedValue>& values,
                           const std::string& overlay = "", bool into_bases = false) const {
    core::Diagnostics diagnostics;
    const behaviors::SaveTarget target{
        overlay.empty() ? "" : file(overlay), into_bases, {file("share")}};
    auto plan = behaviors::plan_save(file(name), options_for_tests(), values, target, diagnostics);
    EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.to_string();
    return plan;
  }
  // What refuses a plan, without the folder's name; empty: nothing.
  std::string refusal(const std::string& name, const std::vector<behaviors::NamedValue>& values,
                      const std::string& overlay = "", bool into_bases = false) const {
    std::string text;
    const auto refused = plan(name, values, overlay, into_bases);
    EXPECT_TRUE(refused.files.empty() || !refused.refused());
    for (const std::string& reason : refused.refusals) text += reason + "\n";
    const std::string prefix = folder_.string() + "/";
    for (std::size_t at = 0; (at = text.find(prefix)) != std::string::npos;) {
      text.erase(at, prefix.size());
    }
    return text;
  }
  // Saves into file b.yaml with this text; what it then holds, or what refused it.
  std::string saved(const std::string& text,
                    const std::vector<behaviors::NamedValue>& values) const {
    put("b.yaml", text);
    const auto made = plan("b.yaml", values);
    if (made.refused()) return made.refusals.front();
    EXPECT_TRUE(behaviors::write_saved(made).empty());
    return get("b.yaml");
  }

  std::filesystem::path folder_ = std::filesystem::temp_directory_path() /
                                  ("footfall_save_" + std::to_string(::getpid()) +
                                   testing::UnitTest::GetInstance()->current_test_info()->name());
};

}  // namespace footfall::tests
