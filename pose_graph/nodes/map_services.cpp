#include "map_services.h"

#include <utility>

namespace vins::pose_graph {

using Response = vins_msgs::MapFile::Response;

MapServices::MapServices(ros::NodeHandle private_node, std::function<void(MapRequest)> hand)
    : hand_(std::move(hand)), spinner_(1, &queue_) {
  private_node.setCallbackQueue(&queue_);
  save_ = advertise(&private_node, "save_map", true);
  load_ = advertise(&private_node, "load_map", false);
  spinner_.start();
}

ros::ServiceServer MapServices::advertise(ros::NodeHandle* node, const std::string& name,
                                          bool saves) {
  const boost::function<bool(vins_msgs::MapFile::Request&, Response&)> callback =
      [this, saves](vins_msgs::MapFile::Request& request, Response& response) {
        return serve(saves, request, &response);
      };
  return node->advertiseService(name, callback);
}

bool MapServices::serve(bool saves, const vins_msgs::MapFile::Request& request,
                        Response* response) {
  auto promise = std::make_shared<std::promise<Response>>();
  std::future<Response> answer = promise->get_future();
  hand_({saves, request.file, std::move(promise)});
  try {
    *response = answer.get();
  } catch (const std::future_error&) {
    response->success = false;
    response->message = "not done: the node is about to end";
  }
  return true;
}

}  // namespace vins::pose_graph
