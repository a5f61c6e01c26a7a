#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <vector>

#include "tests/study/small_scenes.hpp"

/// Settings in processes of their own: at the same time, or one by one by somebody else's engine.
namespace palpate::study {
namespace {

using namespace testing;

void run_program(const std::string& arguments) {
  const std::string command = std::string(PALPATE_BUILD_DIR) + "/bin/palpate study " + arguments;
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
}

/// The rows of a study in a folder, all of whose settings must have been kept.
Result kept(const Scene& scene, const std::filesystem::path& folder) {
  StudyOptions options = quick();
  std::size_t lines = 0;
  options.say = [&](const std::string& line) {
    ++lines;
    EXPECT_TRUE(line.ends_with(": kept")) << line;
  };
  const Result result = run_study(scene, folder, options);
  EXPECT_EQ(lines, count_settings(scene, options));
  return result;
}

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

void expect_same_errors(const Result& found, const Result& expected) {
  ASSERT_EQ(found.rows.size(), expected.rows.size());
  for (std::size_t i = 0; i < found.rows.size(); ++i) {
    const Row &a = found.rows[i], &b = expected.rows[i];
    EXPECT_EQ(a.method + a.knob + a.value + a.reference, b.method + b.knob + b.value + b.reference);
    EXPECT_TRUE(same(a.err_u_rel, b.err_u_rel)) << a.knob << a.value;
    EXPECT_TRUE(same(a.err_f_rel, b.err_f_rel)) << a.knob << a.value;
  }
}

TEST(StudyJobs, GiveWhatOneProcessGivesBesideOneAnotherOrAsTasks) {
  const Folder folder;
  const Scene scene = catheter_scene(folder.at, 10);
  run_study(scene, folder.at / "alone", quick());
  const Result alone = kept(scene, folder.at / "alone");  // files hold six digits
  const std::string file = scene.file.string(), beside = (folder.at / "beside").string(),
                    tasks = (folder.at / "tasks").string();
  run_program(file + " --quick --quiet --jobs 3 -o " + beside + " > /dev/null");
  expect_same_errors(kept(scene, beside), alone);
  EXPECT_NE(text_of(folder.at / "beside/machine.txt").find("3 settings at the same time"), std::string::npos);
  run_program(file + " --quick --tasks -o " + tasks + " > " + tasks + ".sh");
  EXPECT_FALSE(std::filesystem::exists(tasks));
  ASSERT_EQ(std::system(("sh " + tasks + ".sh 2> /dev/null").c_str()), 0);
  expect_same_errors(kept(scene, tasks), alone);
}

TEST(StudyJobs, ASettingThatThereIsNotIsRefused) {
  const Folder folder;
  const Scene scene = block_scene(folder.at);
  EXPECT_THROW(run_setting(scene, folder.at / "out", quick(), 1000), std::runtime_error);
}

}  // namespace
}  // namespace palpate::study
