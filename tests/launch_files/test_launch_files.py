"""Loads every launch file as roslaunch does, without starting anything."""

import io
import os
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
STAGES = ['feature_tracker', 'vins_estimator', 'pose_graph']


def load(name, *args):
    """The configuration that `roslaunch name args` would run."""
    path = os.path.join(FOLDER, name)
    arguments = NEEDED.get(name, []) + list(args)
    return load_config_default([(path, arguments)], None, loader=XmlLoader(resolve_anon=False),
                               verbose=False, assign_machines=False)


def nodes_of(config):
    return {node.name: node for node in config.nodes}


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

    def test_rviz_comes_where_it_is_asked_for_with_a_configuration_that_is_there(self):
        for config in [load('vins_rviz.launch'), load('euroc.launch', 'rviz:=true')]:
            path = nodes_of(config)['rviz'].args.split('"')[1]
            self.assertTrue(os.path.isfile(path), path)
        self.assertNotIn('rviz', nodes_of(load('euroc.launch')))


if __name__ == '__main__':
    unittest.main()
