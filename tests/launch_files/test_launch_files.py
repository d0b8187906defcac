"""Loads every launch file as roslaunch does, without starting anything."""

import io
import os
import re
import unittest
from contextlib import redirect_stderr
from glob import glob

import roslib.packages
import roslaunch.arg_dump
from roslaunch.config import load_config_default
from roslaunch.core import RLException
from roslaunch.xmlloader import XmlLoader

FOLDER = os.path.normpath(os.path.join(os.path.dirname(__file__), '..', '..', 'launch'))
# What a file cannot be loaded without.
NEEDED = {
    'vins.launch': ['config:=' + os.path.join(FOLDER, '../config/euroc/euroc_config.yaml')],
    'relocalize.launch': ['map:=/maps/hall.map'],
    'realsense_d435i.launch': ['driver:=false'],
}
for consumer in ['mavros.launch', 'robot_localization.launch']:
    NEEDED[consumer] = NEEDED['vins.launch']
# Packages that users of a launch file have and we do not need.
OTHERS = ['robot_localization']
# What other people's nodes subscribe, by their documentation: wiki.ros.org/mavros_extras,
# docs.ros.org/en/noetic/api/robot_localization.
SUBSCRIBED = {
    'mavros/odometry/out': 'nav_msgs/Odometry',
    'mavros/vision_pose/pose_cov': 'geometry_msgs/PoseWithCovarianceStamped',
    'odom0': 'nav_msgs/Odometry',
}
STAGES = ['feature_tracker', 'vins_estimator', 'pose_graph']


def load(name, *args):
    """The configuration that `roslaunch name args` would run."""
    path = os.path.join(FOLDER, name)
    arguments = NEEDED.get(name, []) + list(args)
    return load_config_default([(path, arguments)], None, loader=XmlLoader(resolve_anon=False),
                               verbose=False, assign_machines=False)


def nodes_of(config):
    return {node.name: node for node in config.nodes}


def published_types():
    """What the estimator publishes, topic by topic, by its source."""
    source = os.path.join(FOLDER, '..', 'vins_estimator', 'nodes', 'estimator_publisher.cpp')
    with open(source) as text:
        found = re.findall(r'advertise<(\w+)::(\w+)>\("(\w+)"', text.read())
    return {'vins_estimator/' + topic: '%s/%s' % (package, kind) for package, kind, topic in found}


def parameter(config, name):
    return config.params[name].value if name in config.params else None


class LaunchFiles(unittest.TestCase):
    def files(self):
        names = sorted(os.path.basename(path) for path in glob(os.path.join(FOLDER, '*.launch')))
        self.assertGreater(len(names), 5)
        return names

    def rigs(self):
        return [name for name in self.files() if name != 'vins_rviz.launch']

    def test_every_argument_says_what_it_is(self):
        for name in self.files():
            arguments = roslaunch.arg_dump.get_args([os.path.join(FOLDER, name)])
            self.assertTrue(arguments, name)
            for argument, (doc, _) in arguments.items():
                self.assertTrue(doc, '%s: %s' % (name, argument))

    def test_the_same_argument_means_the_same_in_every_file(self):
        meanings = {}
        for name in self.rigs():
            for argument, (doc, _) in roslaunch.arg_dump.get_args(
                    [os.path.join(FOLDER, name)]).items():
                # Up to what is said besides: the camera takes the place of "elsewhere".
                meanings.setdefault(argument, set()).add(doc.split(';')[0].split('with nodelets: ')[-1])
        for argument, docs in meanings.items():
            self.assertEqual(len(docs), 1, '%s: %s' % (argument, docs))

    def test_every_rig_starts_the_three_stages_with_a_configuration_that_is_there(self):
        for name in self.rigs():
            config = load(name)
            self.assertEqual(config.config_errors, [], name)
            for stage in STAGES:
                self.assertIn(stage, nodes_of(config), name)
                path = parameter(config, '/%s/config_file' % stage)
                self.assertTrue(os.path.isfile(path), '%s: %s' % (name, path))

    def test_every_node_of_ours_is_built(self):
        for name in self.rigs():
            for node in load(name).nodes:
                if node.package in OTHERS:
                    continue
                found = roslib.packages.find_node(node.package, node.type)
                self.assertTrue(found, '%s: %s/%s' % (name, node.package, node.type))

    def test_a_bag_is_played_from_start_at_rate_and_its_end_ends_nothing(self):
        for name in self.rigs():
            self.assertNotIn('player', nodes_of(load(name)), name)
            config = load(name, 'bag:=/data/my flight.bag', 'start:=5', 'rate:=0.5')
            player = nodes_of(config)['player']
            self.assertIn('--rate 0.5', player.args)
            self.assertIn('--start 5', player.args)
            self.assertIn('"/data/my flight.bag"', player.args)
            self.assertFalse(player.required or player.respawn, name)

    def test_relative_paths_are_seen_from_the_folder_of_the_user(self):
        here = os.environ.get('PWD', '.')
        config = load('euroc.launch', 'bag:=a.bag', 'config:=rig.yaml', 'load_map:=m/a.map')
        self.assertIn('"%s/a.bag"' % here, nodes_of(config)['player'].args)
        self.assertEqual(parameter(config, '/pose_graph/config_file'), here + '/rig.yaml')
        self.assertEqual(parameter(config, '/pose_graph/load_map'), here + '/m/a.map')

    def test_configurations_can_be_named_as_vins_mono_names_them(self):
        config = load('euroc.launch', 'config_path:=/rigs/mine.yaml')
        for stage in STAGES:
            self.assertEqual(parameter(config, '/%s/config_file' % stage), '/rigs/mine.yaml')

    def test_maps_reach_the_pose_graph(self):
        self.assertIsNone(parameter(load('euroc.launch'), '/pose_graph/load_map'))
        self.assertIsNone(parameter(load('euroc.launch'), '/pose_graph/save_map'))
        config = load('relocalize.launch', 'save_map:=/maps/new.map')
        self.assertEqual(parameter(config, '/pose_graph/load_map'), '/maps/hall.map')
        self.assertEqual(parameter(config, '/pose_graph/save_map'), '/maps/new.map')

    def test_relocalizing_needs_a_map(self):
        with self.assertRaises(RLException), redirect_stderr(io.StringIO()):
            load_config_default([(os.path.join(FOLDER, 'relocalize.launch'), [])], None,
                                loader=XmlLoader(), verbose=False, assign_machines=False)

    def test_nodelets_share_one_manager(self):
        nodes = nodes_of(load('nodelets.launch'))
        self.assertEqual((nodes['vins_manager'].package, nodes['vins_manager'].args),
                         ('nodelet', 'manager'))
        for stage in STAGES:
            self.assertEqual(nodes[stage].package, 'nodelet')
            plugin, manager = nodes[stage].args.split()[1:]
            self.assertEqual(manager, 'vins_manager')
            self.assertTrue(plugin.startswith(stage + '/'), plugin)
            manifest = os.path.join(FOLDER, '..', stage, 'nodelet_plugins.xml')
            with open(manifest) as text:
                self.assertIn('name="%s"' % plugin, text.read())

    def test_nodelets_can_join_the_manager_of_a_camera(self):
        nodes = nodes_of(load('nodelets.launch', 'manager:=/camera/nodelet_manager',
                              'start_manager:=false'))
        self.assertEqual(sorted(nodes), sorted(STAGES))
        self.assertIn('/camera/nodelet_manager', nodes['pose_graph'].args)

    def test_the_pose_graph_can_run_elsewhere(self):
        config = load('vins.launch', 'pose_graph:=false')
        self.assertEqual(sorted(nodes_of(config)), ['feature_tracker', 'vins_estimator'])

    def test_a_namespace_is_that_of_nodes_parameters_and_frames(self):
        for name in self.rigs():
            if name in ['mavros.launch', 'robot_localization.launch']:
                continue  # these go by the frames of their consumer
            config = load(name, 'ns:=left')
            for stage in STAGES:
                self.assertEqual(nodes_of(config)[stage].namespace, '/left/', name)
                self.assertTrue(parameter(config, '/left/%s/config_file' % stage), name)
            self.assertEqual(parameter(config, '/left/vins_estimator/odom_frame'), 'left/odom')
            self.assertEqual(parameter(config, '/left/pose_graph/odom_frame'), 'left/odom')
            self.assertEqual(parameter(config, '/left/pose_graph/map_frame'), 'left/map')
            plain = load(name)
            self.assertEqual(nodes_of(plain)['vins_estimator'].namespace, '/', name)
            self.assertEqual(parameter(plain, '/vins_estimator/odom_frame'), 'odom')

    def test_frames_and_tf_can_be_left_to_the_robot(self):
        config = load('vins.launch', 'base_frame:=base_link', 'body_frame:=imu_link',
                      'camera_frame:=none', 'publish_tf:=0', 'tf_at_imu_rate:=1')
        for key, value in [('base_frame', 'base_link'), ('body_frame', 'imu_link'),
                           ('camera_frame', ''), ('publish_tf', 0), ('tf_at_imu_rate', 1)]:
            self.assertEqual(parameter(config, '/vins_estimator/' + key), value, key)
        self.assertTrue(parameter(config, '/pose_graph/publish_tf'))
        self.assertFalse(parameter(load('vins.launch', 'publish_map_tf:=false'),
                                   '/pose_graph/publish_tf'))

    def test_mavros_gets_messages_of_the_types_that_it_subscribes(self):
        types = published_types()
        for message, topic in [('odometry', 'mavros/odometry/out'),
                               ('pose', 'mavros/vision_pose/pose_cov')]:
            config = load('mavros.launch', 'message:=' + message)
            relay = nodes_of(config)['vins_to_mavros']
            self.assertEqual((relay.package, relay.type), ('topic_tools', 'relay'))
            ours, theirs = relay.args.split()
            self.assertEqual(theirs, topic)
            self.assertEqual(types[ours], SUBSCRIBED[topic])
            # The frames that MAVROS knows.
            self.assertEqual(parameter(config, '/vins_estimator/odom_frame'), 'odom')
            self.assertEqual(parameter(config, '/vins_estimator/base_frame'), 'base_link')
        self.assertIn('uav1/mavros/odometry/out',
                      nodes_of(load('mavros.launch', 'mavros:=uav1/mavros'))['vins_to_mavros'].args)

    def test_robot_localization_fuses_the_odometry_and_alone_publishes_odom_to_base(self):
        config = load('robot_localization.launch')
        ours = parameter(config, '/ekf_localization/odom0')
        self.assertEqual(published_types()[ours], SUBSCRIBED['odom0'])
        self.assertEqual(len(parameter(config, '/ekf_localization/odom0_config')), 15)
        self.assertTrue(parameter(config, '/ekf_localization/publish_tf'))
        self.assertFalse(parameter(config, '/vins_estimator/publish_tf'))
        self.assertTrue(parameter(config, '/pose_graph/publish_tf'), 'map to odom')
        for theirs, key in [('odom_frame', 'odom_frame'), ('world_frame', 'odom_frame'),
                            ('base_link_frame', 'base_frame')]:
            self.assertEqual(parameter(config, '/ekf_localization/' + theirs),
                             parameter(config, '/vins_estimator/' + key), theirs)

    def test_rviz_comes_where_it_is_asked_for_with_a_configuration_that_is_there(self):
        for config in [load('vins_rviz.launch'), load('euroc.launch', 'rviz:=true')]:
            path = nodes_of(config)['rviz'].args.split('"')[1]
            self.assertTrue(os.path.isfile(path), path)
        self.assertNotIn('rviz', nodes_of(load('euroc.launch')))


if __name__ == '__main__':
    unittest.main()
