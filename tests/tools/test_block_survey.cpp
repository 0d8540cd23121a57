// How a run by blocks stands: records of tasks, what is left, and the shares that are submitted.
#include <catch2/catch.hpp>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "engine/pellicle.h"
#include "tests/tools/tool_fixtures.h"
#include "tools/blocks/block_plan.h"
#include "tools/blocks/block_record.h"
#include "tools/blocks/block_survey.h"
#include "tools/blocks/submit_blocks.h"

using plc::tools::BlockGrid;
using plc::tools::BlockPlan;
using plc::tools::BlockSurvey;
using plc::tools::TaskRecord;

namespace {

constexpr std::time_t kNow = 1000000;

// 4 x 2 x 1 blocks, two levels: 16 steps, of which each level has four with two tasks.
BlockPlan a_plan() {
  BlockPlan plan;
  plc_parameters_defaults(&plan.parameters);
  plan.parameters.reduction = 2;
  plan.from_level = 1;
  plan.grid = BlockGrid({400, 200, 100}, 100, 20);
  return plan;
}

class RunFolder {
 public:
  explicit RunFolder(const BlockPlan& plan) : plan_(plan) {
    for (const char* level : {"/level0", "/level1"}) {
      std::filesystem::create_directories(path() + level);
    }
  }
  std::string path() const { return folder_.path(); }
  std::string block(int step, size_t task) const {
    const auto blocks = plan_.grid.blocks_of_colour(step % BlockGrid::kColours);
    return block_path(path(), plan_, step, plan_.grid.block_at(blocks[task]));
  }
  void finish(int step, size_t task, double seconds, double ended, bool converged = true) const {
    TaskRecord record;
    record.seconds = seconds;
    record.ended = ended;
    record.converged = converged;
    record.bricks_read = 5;
    write_record(block(step, task), record);
    std::ofstream(block(step, task)) << "cells";
  }

 private:
  const BlockPlan& plan_;
  fixtures::Folder folder_;
};

}  // namespace

TEST_CASE("A record is read as it was written, and none where it is missing or damaged",
          "[blocks]") {
  const BlockPlan plan = a_plan();
  const RunFolder folder(plan);
  const std::string block = folder.block(0, 0);
  CHECK_FALSE(plc::tools::read_record(block));
  const TaskRecord record{10, 5, 12, 300, false, 1.5, 1000.25, 7, int64_t{1} << 40};
  write_record(block, record);
  CHECK(std::filesystem::exists(folder.path() + "/level1/0-0-0.json"));
  const auto read = plc::tools::read_record(block);
  REQUIRE(read);
  CHECK(record_text(*read) == record_text(record));
  CHECK(read->free == 5);
  CHECK_FALSE(read->converged);
  CHECK(read->peak_bytes == int64_t{1} << 40);
  for (const char* text : {"", "{}", "[1]", "{\"vertices\": \"many\"}"}) {
    std::ofstream(folder.path() + "/level1/0-0-0.json") << text;
    CHECK_FALSE(plc::tools::read_record(block));
  }
}

TEST_CASE("A task is done where its file is, with a record or without", "[blocks]") {
  const BlockPlan plan = a_plan();
  const RunFolder folder(plan);
  BlockSurvey survey = plc::tools::survey_of(folder.path(), plan, kNow);
  CHECK(survey.tasks == 16);
  CHECK(survey.left == 16);
  CHECK(survey.seconds_left < 0);
  CHECK(survey.steps[0].left == std::vector<int64_t>{0, 2});
  CHECK(survey.steps[3].left == std::vector<int64_t>{5, 7});
  CHECK(survey.steps[4].tasks == 0);
  folder.finish(0, 1, 10, kNow - 5);
  std::filesystem::remove(folder.path() + "/level1/2-0-0.json");
  write_record(folder.block(0, 0), TaskRecord{});  // killed before it wrote its file
  survey = plc::tools::survey_of(folder.path(), plan, kNow);
  CHECK(survey.left == 15);
  CHECK(survey.steps[0].left == std::vector<int64_t>{0});
  CHECK(survey.levels[1].recorded == 0);
}

TEST_CASE("The time that is left follows the pace, the level and the order of steps", "[blocks]") {
  const BlockPlan plan = a_plan();
  const RunFolder folder(plan);
  // 30 seconds each; five have ended within the last minute.
  for (const int step : {0, 1, 2}) {
    for (const size_t task : {size_t{0}, size_t{1}})
      folder.finish(step, task, 30, kNow - 60 + 30 * step);
  }
  folder.finish(3, 0, 30, kNow, false);
  const BlockSurvey survey = plc::tools::survey_of(folder.path(), plan, kNow);
  CHECK(survey.levels[1].restless == 1);
  CHECK(survey.levels[1].bricks_read == 35);
  CHECK(survey.task_seconds[1] == Approx(30));
  CHECK(survey.task_seconds[0] == Approx(120));  // four times the vertices
  CHECK(survey.pace == Approx(2.5));
  // The one that is left of its step, then four steps of two tasks, none in less than one takes.
  CHECK(survey.seconds_left == Approx(30 + 4 * 120));
  const std::string text = status_text(survey, plan, kNow);
  CHECK_THAT(text, Catch::Contains("step 3   level 1       1 done      1 left\n"));
  CHECK_THAT(text, !Catch::Contains("step 4 "));
  CHECK_THAT(text, Catch::Contains("level 1  has not converged in 1 of 7 tasks"));
  CHECK_THAT(text, Catch::Contains("in about 9 min as it goes now"));
  // An hour later nobody is at work.
  const BlockSurvey later = plc::tools::survey_of(folder.path(), plan, kNow + 3600);
  CHECK(later.pace == 0);
  CHECK(later.seconds_left == Approx(30 + 8 * 120));
  CHECK_THAT(status_text(later, plan, kNow + 3600), Catch::Contains("nothing ends at present"));
}

TEST_CASE("Only shares that have blocks left are submitted", "[blocks]") {
  const std::vector<int64_t> blocks = {0, 2, 4, 6, 8, 10, 12};
  CHECK(plc::tools::shares_left(blocks, blocks, 7) == "1-7");
  CHECK(plc::tools::shares_left(blocks, blocks, 3) == "1-3");
  CHECK(plc::tools::shares_left(blocks, {0, 4, 6, 12}, 7) == "1,3-4,7");
  CHECK(plc::tools::shares_left(blocks, {2, 8}, 3) == "2");
  CHECK(plc::tools::shares_left(blocks, {12}, 3) == "1");
}
