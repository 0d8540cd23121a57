// How a run by blocks stands, from its files alone.
#pragma once
#include <cstdint>
#include <ctime>
#include <string>
#include <vector>

#include "tools/blocks/block_plan.h"

namespace plc::tools {

struct StepSurvey {
  int64_t tasks = 0;
  std::vector<int64_t> left;  // their blocks, ascending
};

// Of the tasks of a level that are done and have a record.
struct LevelSurvey {
  int64_t recorded = 0;
  int64_t restless = 0;  // that have not converged
  int64_t bricks_read = 0, peak_bytes = 0;
  double seconds = 0, longest_seconds = 0;  // sum and maximum
};

struct BlockSurvey {
  std::vector<StepSurvey> steps;
  std::vector<LevelSurvey> levels;  // by their numbers: 0 is the image
  int64_t tasks = 0, left = 0;
  // That a task of a level takes, from what was measured on it, or else on another one; 0: nothing
  // was measured.
  std::vector<double> task_seconds;
  double pace = 0;  // seconds of tasks that end in a second of late; 0: nobody is at work
  double seconds_left =
      -1;  // as it goes now, or, at no pace, of one task after the other; -1: not known
};

BlockSurvey survey_of(const std::string& folder, const BlockPlan& plan, std::time_t now);

// Lines for people: each step, what levels took, where they have not converged, and when the rest
// is.
std::string status_text(const BlockSurvey& survey, const BlockPlan& plan, std::time_t now);
std::string status_json(const BlockSurvey& survey, const BlockPlan& plan, std::time_t now);

}  // namespace plc::tools
