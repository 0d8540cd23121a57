#include "engine/detect/detection.h"

#include "engine/base/constants.h"

namespace plc {

Detection::Detection(Mesh& mesh, const Executor& executor)
    : mesh_(mesh),
      executor_(executor),
      due_(mesh, executor),
      hash_(executor.simd()),
      surroundings_(mesh, executor) {}

void Detection::list_due() {
  due_.list_due();
  all_due_ = false;
}

void Detection::list_due(const Vector<uint32_t>& awake, const VertexBytes& calm) {
  due_.list_due(awake, calm);
  all_due_ = false;
}

void Detection::list_all() {
  due_.list_all();
  all_due_ = true;
}

// A vertex is due before it has moved farther than the slack, and is entered anew then.
void Detection::update_hash() {
  if (all_due_ || !hash_valid_ || is_many(due().size() + hash_.inserted())) {
    build_hash();
    hash_valid_ = true;
    return;
  }
  hash_.insert(mesh_, due(), executor_);
}

void Detection::shorten_hash() {
  if (is_many(hash_.inserted())) build_hash();
}

void Detection::build_hash() {
  const auto delta = static_cast<float>(mesh_.delta);
  hash_.build(mesh_, kHashCell * delta, executor_, kHashSlack * delta);
}

bool Detection::is_many(size_t entries) const {
  return entries > mesh_.slots() / kHashInsertions;
}

void Detection::search_near_all() {
  list_all();
  update_hash();
  // Every vertex has just been entered where it is.
  hash_.set_slack(0);
  surroundings_.search_near(due(), hash_);
  hash_.set_slack(kHashSlack * static_cast<float>(mesh_.delta));
}

}  // namespace plc
