"""Commands, functions and files that are refused, for the frozen texts, and commands that succeed.

Inputs that tests were found to refuse stand in found_inputs.json; those here reach the rest.
"""

from __future__ import annotations

import shlex
from collections.abc import Iterator
from typing import Any

import rexs_files

__all__ = ["broken_commands", "sound_commands"]

Tables = dict[str, Any]

TIMES = "time [s],speed [rpm],torque [N*m],temperature [degC]\n"
SHARES = "share,speed [rpm],torque [N*m],temperature [degC]\n"
CYCLE = f"{TIMES}0,500,20,60\n10,1500,60,70\n30,0,0,80\n"
PLAIN = "time [s],speed [rpm],torque [N*m]\n0,500,20\n10,1500,60\n30,0,0\n"
MEASURED = (
    "speed [rpm],torque [N*m],temperature [degC],loss [W],uncertainty [W],rig\n"
    "2000,50,60,120,5,a\n4000,50,60,260,8,a\n2000,100,60,210,5,b\n4000,100,80,390,8,b\n"
)
PAIR = "talbot-2012-pair"
SWEEP = f"sweep {PAIR} --vary pinion.teeth=24,25"
MAP = f'map {PAIR} --speed "1,2 rpm" --torque "1,2 N*m"'
STATES = 'map train-8hp70 --speed "1,2 rpm" --torque "1,2 N*m"'
FEW = (
    "--set numerics.mesh_positions=5 --set numerics.contact_segments=5 "
    "--set losses.mesh_pocketing.include=false --jobs 1"
)

COMMANDS: dict[str, str] = {
    "nothing": "",
    "no command": "rum talbot-2012",
    "no case": "run",
    "two cases": "run talbot-2012 talbot-2012-pair",
    "unknown option": "run talbot-2012 --torque 5",
    "unknown case": "run talbot-2013",
    "file that is not there": "run nothing.toml",
    "set without value": "run talbot-2012 --set operation.torque",
    "set without key": "run talbot-2012 --set =3",
    "set of no key": 'run talbot-2012 --set "operation.tork=5 N*m"',
    "set of wrong unit": 'run talbot-2012 --set "operation.torque=5 bar"',
    "set of nothing": "run talbot-2012 --set sun.teeth=",
    "set of several": 'run talbot-2012 --set "{sun,planet}.teeth=none"',
    "set of open braces": 'run talbot-2012 --set "{sun,planet.teeth=3"',
    "save without ending": "run talbot-2012-pair --save result",
    "save into no folder": "run talbot-2012-pair --save no/folder/r.nc",
    "json into no folder": "run talbot-2012-pair --json no/folder/r.json",
    "check of a broken case": "check talbot-2012 --set planet.count=9",
    "friction of given losses": "friction train-8hp70",
    "mesh of given losses": "mesh train-8hp70",
    "mesh without load": f'mesh {PAIR} --set "operation.torque=0 N*m"',
    "mesh with a wrong picture": f"mesh {PAIR} --plot m.bmp",
    "pockets of given losses": "pockets train-8hp70",
    "pockets left out": f"pockets {PAIR} --set losses.mesh_pocketing.include=false",
    "pockets at rest": f'pockets {PAIR} --set "operation.speed=0 rpm"',
    "pockets with a wrong animation": f"pockets {PAIR} --animate p.mp4",
    "sweep of nothing": f"sweep {PAIR} -o s.nc",
    "sweep without output": f'sweep {PAIR} --vary "operation.speed=1,2 rpm"',
    "sweep into another format": f'sweep {PAIR} --vary "operation.speed=1,2 rpm" -o s.xyz',
    "sweep without values": f"sweep {PAIR} --vary operation.speed -o s.nc",
    "sweep of one key twice": f"sweep {PAIR} --vary pinion.teeth=24,25 --vary pinion.teeth=25 "
                              "-o s.nc",
    "sweep of equal values": f'sweep {PAIR} --vary "operation.speed=1,1 rpm" -o s.nc',
    "sweep of no key": f'sweep {PAIR} --vary "operation.sped=1,2 rpm" -o s.nc',
    "sweep of a table": f"sweep {PAIR} --vary pinion=1,2 -o s.nc",
    "sweep of a list": "sweep talbot-2012 --vary planet.angles=1,2 -o s.nc",
    "sweep of a wrong unit": f'sweep {PAIR} --vary "operation.speed=1,2 mm" -o s.nc',
    "sweep of a wrong range": f'sweep {PAIR} --vary "operation.speed=1:2 rpm" -o s.nc',
    "sweep of a range of words": f'sweep {PAIR} --vary "operation.speed=a:b:3 rpm" -o s.nc',
    "sweep of a range of none": f'sweep {PAIR} --vary "operation.speed=1:2:0 rpm" -o s.nc',
    "sweep of a range of fractions": f'sweep {PAIR} --vary "operation.speed=1:2:2.5 rpm" -o s.nc',
    "sweep together of unequal": f'sweep {PAIR} --vary-together "pinion.teeth=24,25; '
                                 'operation.speed=1,2,3 rpm" -o s.nc',
    "sweep together of nothing": f'sweep {PAIR} --vary-together "" -o s.nc',
    "sweep together and alone": f'{SWEEP} --vary-together '
                                '"pinion.teeth=24,25; gear.teeth=25,26" -o s.nc',
    "sweep of points and of a file": f"sweep {PAIR} --points nothing.csv -o s.nc",
    "link without expression": f'{SWEEP} --link "gear.teeth" -o s.nc',
    "link twice": f'{SWEEP} --link "gear.teeth=pinion.teeth" '
                  '--link "gear.teeth=3" -o s.nc',
    "link of what is varied": f'{SWEEP} --link '
                              '"pinion.teeth=gear.teeth" -o s.nc',
    "link of a word": f'{SWEEP} --link "models.friction=3" -o s.nc',
    "link of no key": f'{SWEEP} --link "gear.teth=3" -o s.nc',
    "link from no key": f'{SWEEP} --link "gear.teeth=pinion.teth" '
                        "-o s.nc",
    "link in a circle": f'sweep {PAIR} --vary "operation.speed=1,2 rpm" --link '
                        '"gear.teeth=pinion.teeth" --link "pinion.teeth=gear.teeth" -o s.nc',
    "link of nonsense": f'{SWEEP} --link "gear.teeth=2 +* 3" -o s.nc',
    "link of a call": f'{SWEEP} --link "gear.teeth=open(3)" -o s.nc',
    "link without value": f'{SWEEP} --link '
                          '"gear.teeth=1/(pinion.teeth-24)" -o s.nc',
    "link of a unit": f'{SWEEP} --link '
                      '"gear.face_width=pinion.roughness*2" -o s.nc',
    "link of a fraction": f'{SWEEP} --link '
                          f'"gear.teeth=pinion.teeth/7" {FEW} -o s.csv',
    "shard of words": f'{SWEEP} --shard one -o s.nc',
    "shard beyond": f'{SWEEP} --shard 3/2 -o s.nc',
    "shard of many": f'{SWEEP} --shard 1/99999999 -o s.nc',
    "cluster that is not there": f'{SWEEP} --dask nonsense -o s.nc',
    "jobs of none": f"sweep {PAIR} --vary pinion.teeth=24,25 --jobs 0 -o s.nc",
    "map without axes": f"map {PAIR} -o m.nc",
    "map without torque": f'map {PAIR} --speed "0,1 rpm" -o m.nc',
    "map of no values": f'map {PAIR} --speed "" --torque "x" -o m.nc',
    "map of a wrong unit": f'map {PAIR} --speed "1,2 mm" --torque "1,2 N*m" -o m.nc',
    "map of another format": f'{MAP} -o m.xyz',
    "map of no format": f'{MAP} -o m.nc --format xyz',
    "map of states": f'{MAP} --states 1,2 -o m.nc',
    "map of no states": f'{STATES} --states 1,12 -o m.nc',
    "map with an idle temperature": f'{STATES} '
                                    '--temperature "40 degC" -o m.nc',
    "map that varies its axis": f'{MAP} '
                                '--vary "operation.speed=1,2 rpm" -o m.nc',
    "map that varies its state": f'{STATES} '
                                 "--vary operation.state=1,2 -o m.nc",
    "map that varies its shafts": 'map talbot-2012 --speed "1,2 rpm" --torque "1,2 N*m" '
                                  "--vary operation.fixed=ring,carrier -o m.nc",
    "map that varies twice": f'{MAP} --vary pinion.teeth=1 '
                             "--vary pinion.teeth=2 -o m.nc",
    "map for vecto": f'map {PAIR} --speed "-1,2 rpm" --torque "1,2 N*m" -o m.vtlm --format vecto',
    "map of few points for vecto": f'map {PAIR} --speed "0,10 rpm" --torque "-1,1 N*m" '
                                   "--even-torques -o m.vtlm --format vecto",
    "map at rest with a state": f'map {PAIR} --speed "0,10 rpm" --torque "0,1 N*m" --temperature '
                                '"20,60 degC" --set "operation.speed=0 rpm" --set '
                                f'"thermal.oil_flow=2 l/min" {FEW} --temperature-state -o m.nc',
    "map for modelica": f'{MAP} -o m.mo --format modelica',
    "map for gem": f'map {PAIR} --speed "-1,2 rpm" --torque "1,2 N*m" -o m.csv --format gem',
    "map for an fmu": f'map {PAIR} --speed "0 rpm" --torque "1,2 N*m" -o m.fmu',
    "map for a workbook": f'map {PAIR} --speed "0:10:2000 rpm" --torque "0:10:2000 N*m" -o m.xlsx',
    "map of several temperatures for vecto": f'map {PAIR} --speed "0:10:4 rpm" --torque '
                                             '"-1,0,2 N*m" --temperature "20,40 degC" -o m.vtlm '
                                             "--format vecto",
    "map of states in one file": 'map train-8hp70 --speed "0:10:4 rpm" --torque "-1,0,2 N*m" '
                                 '--states "1,1" -o m.vtlm --format vecto',
    "map with a temperature state": f'map {PAIR} --speed "0:10:4 rpm" --torque "-1,0,2 N*m" '
                                    "--temperature-state -o m.fmu",
    "map of one temperature as a state": f"{MAP} --temperature-state -o m.nc",
    "map of given losses with a state": f"{STATES} --temperature-state -o m.nc",
    "heat without a way out": f"heat {PAIR}",
    "heat of given losses": "heat train-8hp70",
    "heat without target": f'heat {PAIR} --solve oil_flow --set "thermal.oil_flow=2 l/min"',
    "heat with a target": f'heat {PAIR} --target "90 degC" --set "thermal.oil_flow=2 l/min"',
    "heat of a wrong target": f"heat {PAIR} --solve oil_flow --target warm",
    "heat of no quantity": f'heat {PAIR} --solve luck --target "90 degC"',
    "heat beyond reach": f'heat {PAIR} --solve oil_flow --target "30 degC"',
    "warm-up without duration": f"warm-up {PAIR}",
    "warm-up of a wrong duration": f'warm-up {PAIR} --for "3 mm"',
    "warm-up without volume": f'warm-up {PAIR} --for "2 h" --set "thermal.oil_flow=2 l/min"',
    "warm-up of given losses": 'warm-up train-8hp70 --for "2 h"',
    "warm-up to an outlet": f'warm-up {PAIR} --for "2 h" --from cold '
                            '--set "thermal.oil_outlet_temperature=99 degC"',
    "warm-up without mass": f'warm-up {PAIR} --for "2 h" --set "thermal.oil_volume=2 l" '
                            '--set "thermal.housing.area=0.3 m^2"',
    "warm-up into another format": f'warm-up {PAIR} --for "2 h" -o w.xyz',
    "uncertainty of odd samples": f"uncertainty {PAIR} --samples 100",
    "uncertainty of one axis": f'uncertainty {PAIR} --speed "1,2 rpm"',
    "uncertainty at temperatures": f'uncertainty {PAIR} --temperature "40,60 degC"',
    "uncertainty of points": f"uncertainty {PAIR} --points 4",
    "uncertainty of a missing cycle": f"uncertainty {PAIR} none.csv",
    "uncertainty into another format": f"uncertainty {PAIR} -o u.csv",
    "uncertainty of given losses": "uncertainty train-8hp70",
    "uncertainty of exact inputs": "compare-cases train-8hp70 train-8hp70",
    "compare-cases of other kinds": "compare-cases talbot-2012 nothing",
    "study of nothing": f'study {PAIR} --what "" -o s',
    "study of no name": f"study {PAIR} --what speeed,backlash -o s",
    "study of no mesh": f"study {PAIR} --mesh sun_mesh --what speed -o s",
    "study at rest": f'study {PAIR} --set "operation.speed=0 rpm" --what speed -o s',
    "study of no range": f'study {PAIR} --range "sped=1,2 rpm" --what speed -o s',
    "study of another range": f'study {PAIR} --range "module=1,2 mm" --what speed -o s',
    "study of another level": f'study {PAIR} --level "module=1,2 mm" --what speed -o s',
    "study of no level": f'study {PAIR} --level "modul=1,2 mm" --what speed -o s',
    "study of a wrong range": f'study {PAIR} --range "speed=1,2 mm" --what speed -o s',
    "study without values": f"study {PAIR} --range speed= --what speed -o s",
    "study of shares": f"study {PAIR} --range oil-fraction=0.1,1.4 --what oil-fraction -o s",
    "study of large modules": f'study {PAIR} --range "module=40,80 mm" --what module -o s',
    "study of impossible helices": f'study {PAIR} --range "helix-angle=10,89 deg" --what '
                                   "helix-angle --jobs 1 -o s",
    "pockets-table without speeds": f"pockets-table {PAIR} -o p.nc",
    "pockets-table at rest": f'pockets-table {PAIR} --speed "0 rpm" -o p.nc',
    "pockets-table of wrong speeds": f'pockets-table {PAIR} --speed "1,2 mm" -o p.nc',
    "pockets-table into another format": f'pockets-table {PAIR} --speed "1,2 rpm" -o p.xlsx',
    "pockets-table without interpolation": f'pockets-table {PAIR} --speed "1,2 rpm" --set '
                                           "numerics.pocket_interpolation=0 -o p.nc",
    "pockets-table of no outline": f'pockets-table {PAIR} --speed "1000 rpm" --set '
                                   '"pinion.tool_tip_radius=2 mm" -o p.nc',
    "oils of no name": "oils iso-vg-100-minerl",
    "init twice": "init c.toml --kind train --like talbot-2012",
    "init minimal and like": "init c.toml --minimal --like talbot-2012",
    "init like nothing": "init c.toml --like nothing",
    "init of no kind": "init c.toml --kind gearbox",
    "init into no folder": "init no/folder/c.toml",
    "report into another format": f"report {PAIR} -o r.txt",
    "report of no size": f'report {PAIR} -o r.html --size big',
    "report of a tiny size": f'report {PAIR} -o r.html --size "1x2 mm"',
    "report of dots": f'report {PAIR} -o r.html --size "1.2.3x2 mm"',
    "report of nothing": "report nothing.nc -o r.html",
    "plot of nothing": f"plot {PAIR} beauty",
    "plot into another format": f"plot {PAIR} losses -o l.bmp",
    "plot of a size": f"plot {PAIR} losses --size 3",
    "plot of another file": f"plot {PAIR} planet-loads -o l.png",
    "plot of dots": f"plot {PAIR} losses --dpi 5",
    "rexs of nothing": "rexs import nothing.rexs",
    "rexs of no ending": "rexs import nothing.txt",
    "rexs export of no ending": f"rexs export {PAIR} -o r.txt",
    "rexs export beside nothing": f"rexs export {PAIR} nothing.rexs -o r.rexs",
    "reproduce of no figure": "reproduce 4 --figure 9.99 -o f",
    "reproduce of no chapter": "reproduce 7",
    "validate both": "validate --temperatures --bands",
    "validate bands into a page": "validate --bands -o v.html",
    "validate into another format": "validate -o v.txt",
    "app of no case": "app talbot-2013 --no-browser",
    "app nowhere": "app talbot-2012 --host 203.0.113.7 --no-browser",
    "schema with more": "schema talbot-2012",
    "cases with more": "cases talbot-2012",
    "merge of nothing": "merge -o s.nc",
    "merge of no file": "merge none.shard -o s.nc",
    "contact of nothing": "contact",
    "contact of a missing file": "contact none.toml",
    "contact of words": "contact --radius big --load heavy --speed fast --slip 3 --oil butter "
                        "--temperature warm",
    "contact of load and pressure": 'contact --radius "10 mm" --pressure "1 GPa" --load "5 N/mm" '
                                    '--speed "10 m/s" --slip 0.2 --oil atf-talbot-2012 '
                                    '--temperature "90 degC"',
    "contact with a wrong picture": "contact --plot c.bmp",
    "oil without command": "oil",
    "oil show of nothing": "oil show none.json",
    "oil fit of nothing": "oil fit none",
    "oil fit of two": "oil fit one two",
    "oil characterise of nothing": "oil characterise butter -o d --size 4",
    "oil characterise of no file": "oil characterise none.toml -o d --size 4",
    "oil characterise of ranges": 'oil characterise atf-talbot-2012 -o d --range "radius=5:10 mm"',
    "oil characterise of no range": "oil characterise atf-talbot-2012 -o d --size 4 --range radius",
    "oil characterise of no axis": 'oil characterise atf-talbot-2012 -o d --size 4 --range '
                                   '"beauty=1:2 mm"',
    "oil characterise of a wrong unit": 'oil characterise atf-talbot-2012 -o d --size 4 --range '
                                        '"radius=1:2 rpm" --range "radius=a:b mm"',
    "oil characterise that falls": 'oil characterise atf-talbot-2012 -o d --size 4 --range '
                                   '"radius=20:10 mm"',
    "oil characterise from zero": 'oil characterise atf-talbot-2012 -o d --size 4 --range '
                                  '"radius=0:10 mm"',
    "oil characterise from pure rolling": 'oil characterise atf-talbot-2012 -o d --size 4 '
                                          "--range slide_to_roll_ratio=0:1",
    "oil characterise beyond": 'oil characterise atf-talbot-2012 -o d --size 4 --range '
                               '"hertz_pressure=0.3:50 GPa"',
    "oil characterise of rough flanks": 'oil characterise atf-talbot-2012 -o d --size 4 --range '
                                        '"roughness1=0.1:9 um" --range "roughness2=0.1:9 um"',
    "oil characterise of axes": 'oil characterise atf-talbot-2012 -o d --size 4 --set '
                                '"contact.radius=9 mm" --set surface1.seed=3 --set '
                                "surface1.profile=p.csv",
}  # fmt: skip

CONTACT = (
    'contact --radius "10 mm" --pressure "1 GPa" --speed "10 m/s" --slip 0.2 '
    '--oil atf-talbot-2012 --temperature "90 degC"'
)
CONTACTS: dict[str, str] = {
    "seed of a smooth surface": "--set surface1.seed=3",
    "profile of a generated surface": '--roughness1 "0.4 um" --set "surface1.cutoff=0.8 mm"',
    "seed of a measured surface": "--set surface1.profile=p.csv --set surface1.seed=3",
    "profile that is not there": "--set surface1.profile=none.csv",
    "flat profile": "--set surface1.profile=flat.csv",
    "profile of words": "--set surface1.profile=words.csv",
    "profile of one point": "--set surface1.profile=one.csv",
    "profile that is uneven": "--set surface1.profile=uneven.csv",
    "cutoff beyond the profile": '--set surface1.profile=p.csv --set "surface1.cutoff=80 mm"',
    "cutoffs exchanged": '--set surface1.profile=p.csv --set "surface1.cutoff=0.02 mm" --set '
                         '"surface1.short_cutoff=0.04 mm"',
    "kurtosis that cannot be": '--roughness1 "0.4 um" --set surface1.skewness=2 --set '
                               "surface1.kurtosis=3",
    "kurtosis that is not reached": '--roughness1 "0.4 um" --set surface1.skewness=-8 --set '
                                    "surface1.kurtosis=900",
    "negative roughness": '--roughness1 "-0.4 um"',
    "law without numbers": "--set lubricant.pressure_law=two-slope "
                           "--set lubricant.shear_law=carreau",
    "numbers without a law": "--set lubricant.pressure_law=roelands "
                             "--set lubricant.slope_ratio=0.4",
    "no preset": "--preset strange",
    "heating without numbers": "--set heating.model=full --set heating.solid_conductivity=-1",
    "numerics": "--set numerics.nodes=2 --set numerics.tolerance=7",
    "stress of zero": '--set "lubricant.eyring_stress=0 MPa"',
    "shear law of nothing": '--set lubricant.shear_law=carreau --set lubricant.shear_exponent=0 '
                            '--set "lubricant.shear_stress=0 MPa"',
}  # fmt: skip
PROFILES = {
    "p.csv": "\n".join(f"{0.005 * k:.3f},{(k * 7 % 5) / 5 - 0.4:.2f}" for k in range(60)) + "\n",
    "flat.csv": "\n".join(f"{0.005 * k:.3f},0" for k in range(60)) + "\n",
    "words.csv": "position,height\na,b\nc,d\n",
    "one.csv": "0,1\n",
    "uneven.csv": "0,1\n0.005,2\n0.02,1\n0.025,0\n0.03,1\n",
}

CYCLES: dict[str, str] = {
    "nothing": "",
    "header only": TIMES,
    "one row": f"{TIMES}0,500,20,60\n",
    "no speed": "time [s],torque [N*m],temperature [degC]\n0,20,60\n1,20,60\n",
    "no weight": "speed [rpm],torque [N*m],temperature [degC]\n500,20,60\n500,20,60\n",
    "two weights": "time [s],share,speed [rpm],torque [N*m],temperature [degC]\n0,1,5,2,60\n"
                   "1,1,5,2,60\n",
    "twice": "time [s],speed [rpm],speed [rad/s],torque [N*m],temperature [degC]\n0,1,5,2,60\n"
             "1,1,5,2,60\n",
    "wrong unit": "time [mm],speed [rpm],torque [N*m],temperature [degC]\n0,500,20,60\n1,5,2,60\n",
    "words": f"{TIMES}0,fast,20,60\n1,5,much,60\n"
             "2,5,,60\n",
    "falling": f"{TIMES}1,500,20,60\n0,5,2,60\n",
    "shares of zero": f"{SHARES}0,500,20,60\n0,5,2,60\n",
    "negative shares": f"{SHARES}-1,500,20,60\n1,5,2,60\n",
    "beyond the map": f"{SHARES}1,9000,900,20\n1,5,2,60\n",
    "without temperature": PLAIN,
    "with states": "share,speed [rpm],torque [N*m],temperature [degC],state\n1,500,20,60,1\n",
    "cold": f"{SHARES}1,500,20,-300\n",
    "ragged": f"{TIMES}0,500,20,60\n1,500\n",
}  # fmt: skip

MEASUREMENTS: dict[str, str] = {
    "nothing": "",
    "header only": "speed [rpm],torque [N*m],loss [W]\n",
    "no loss": "speed [rpm],torque [N*m]\n1000,50\n",
    "no columns": "a,b\n1,2\n",
    "no name": "speed [rpm],[],loss [W]\n1000,50,3\n",
    "two of a name": "speed [rpm],speed [rpm],torque [N*m],loss [W]\n1000,1000,50,3\n",
    "misspelt": "speed [rpm],torqe [N*m],loss [W]\n1000,50,3\n",
    "no key": "speed [rpm],torque [N*m],pinion.teth,loss [W]\n1000,50,25,3\n",
    "list of the case": "speed [rpm],torque [N*m],pinion.micro_geometry.topography.diameter,"
                        "loss [W]\n1000,50,25,3\n",
    "unit of a word": "speed [rpm],torque [N*m],models.friction [mm],loss [W]\n1000,50,schlenk,3\n",
    "words": "speed [rpm],torque [N*m],loss [W]\n1000,much,3\n1000,50,little\n",
    "same twice": "speed [rpm],torque [N*m],loss [W]\n1000,50,3\n1000,50,3\n",
    "no component": "speed [rpm],torque [N*m],loss [W],component\n1000,50,3,beauty\n",
    "no temperature": "speed [rpm],torque [N*m],loss [W]\n1000,50,3\n",
    "wrong rows": "speed [rpm],torque [N*m],temperature [degC],pinion.teeth,loss [W]\n"
                  "1000,50,60,2,3\n1000,50,60,900,3\n",
    "hot oil": "speed [rpm],torque [N*m],temperature [degC],loss [W]\n1000,50,249,3\n",
    "cold oil": "speed [rpm],torque [N*m],temperature [degC],loss [W]\n1000,50,-50,3\n",
    "wrong unit": "speed [mm],torque [N*m],loss [bar]\n1000,50,3\n",
    "negative uncertainty": "speed [rpm],torque [N*m],loss [W],uncertainty [W]\n1000,50,3,-1\n",
    "uncertainty of zero": "speed [rpm],torque [N*m],loss [W],uncertainty [%]\n1000,50,3,0\n",
    "no point can be computed": "speed [rpm],torque [N*m],temperature [degC],loss [W]\n"
                                "1000,50,1e4,3\n",
    "no state": "speed [rpm],torque [N*m],state,loss [W]\n1000,50,1,3\n",
    "ragged": "speed [rpm],torque [N*m],loss [W]\n1000,50\n",
}  # fmt: skip
COMPARISONS: dict[str, str] = {
    "group of no column": "--group beauty",
    "fit of no key": "--fit pinion.teth",
    "fit of a whole number": "--fit pinion.teeth",
    "fit of a column": "--fit operation.torque",
    "fit without influence": "--fit contact_solver.error",
    "fit of too many": "--fit pinion.roughness,gear.roughness,pinion.face_width,gear.face_width,"
                       "surroundings.oil_air_ratio,surroundings.pressure",
    "fit of a zero": "--fit mesh.misalignment",
    "hold-out without fit": "--hold-out 0.3",
    "hold-out of nothing": "--fit pinion.roughness --hold-out beauty",
    "hold-out of no column": "--fit pinion.roughness --hold-out colour=red",
    "hold-out of no row": "--fit pinion.roughness --hold-out rig=c",
    "hold-out of all": "--fit pinion.roughness --hold-out 1.5",
    "output without fit": "-o fitted.toml",
    "output of another ending": "--fit pinion.roughness -o fitted.nc",
    "component that is no loss": "--component beauty",
    "as tested without load": "--load-dependent as-tested --component mesh_sliding",
    "as tested with an outlet": "--load-dependent as-tested --component load_dependent --set "
                                '"thermal.oil_outlet_temperature=99 degC" --set '
                                "models.temperatures=network",
    "neither way": "--load-dependent guessed",
    "shard of a fit": "--shard 1/2 --fit pinion.roughness --hold-out 0.5 --journal j",
    "shard without a file": "--shard 1/2",
    "picture of another ending": "--plot p.bmp",
}  # fmt: skip

OF_MAPS: dict[str, tuple[str, list[str]]] = {
    "options of a stored map": ('map map.nc --speed "1,2 rpm" --states 1 -o n.nc', ["map.nc"]),
    "temperature state of one": ("map cool.nc --temperature-state -o n.nc", ["cool.nc"]),
    "temperature state of a network": (
        "map network.nc --temperature-state -o n.nc", ["network.nc"]),
    "stored map without format": ("map map.nc -o n.xyz", ["map.nc"]),
    "stored map for vecto": ("map map.nc -o n.vtlm --format vecto", ["map.nc"]),
    "stored map backwards": ("map backwards.nc -o n.mo --format modelica", ["backwards.nc"]),
    "stored map of further values": ("map varied.nc -o n.mo --format modelica", ["varied.nc"]),
    "stored result as a map": ("map pair.nc -o n.csv", ["pair.nc"]),
    "stored sweep as a map": ("map sweep.nc -o n.csv", ["sweep.nc"]),
    "duty at rest": ("duty rest.nc cycle.csv", ["rest.nc"]),
    "duty of further values": ("duty varied.nc plain.csv", ["varied.nc"]),
    "duty of states without": ("duty states.nc plain.csv", ["states.nc"]),
    "duty of other states": ("duty states.nc states.csv", ["states.nc"]),
    "duty of given losses at a temperature": (
        'duty states.nc ones.csv --temperature "40 degC"', ["states.nc"]),
    "duty of temperatures": ("duty map.nc plain.csv", ["map.nc"]),
    "map of two driven shafts": ("map driven.nc -o d.mo --format modelica", ["driven.nc"]),
    "duty of two driven shafts": ("duty driven.nc cycle.csv", ["driven.nc"]),
    "merge of a shard that is cut": ("merge a.nc.shard-1-of-2 a.nc.shard-2-of-2 -o s.csv",
                                     ["a.nc.shard-1-of-2", "a.nc.shard-2-of-2"]),
    "plot of a band": ("plot band.nc beauty", ["band.nc"]),
    "duty of two temperatures": (
        'duty map.nc cycle.csv --temperature "40 degC"', ["map.nc"]),
    "duty of equal temperatures": (
        'duty map.nc plain.csv --temperature "40 degC" --temperature "40 degC"', ["map.nc"]),
    "duty of wrong temperatures": ("duty map.nc plain.csv --temperature warm", ["map.nc"]),
    "duty beyond the map": ("duty cool.nc cycle.csv", ["cool.nc"]),
    "duty of a map with a case": ("duty map.nc cycle.csv --set pinion.teeth=9 --map n.nc "
                                  "--shard 1/2", ["map.nc"]),
    "duty into another format": ("duty map.nc cycle.csv -o d.xyz", ["map.nc"]),
    "duty of a folder": ("duty map.nc .", ["map.nc"]),
    "duty of another ending": ("duty map.nc cycle.txt", ["map.nc"]),
    "duty of no parquet": ("duty map.nc cycle.parquet", ["map.nc"]),
    "uncertainty of a map with changes": (
        'uncertainty map.nc --set pinion.teeth=9 --speed "1,2 rpm" --torque "1,2 N*m"', ["map.nc"]),
    "uncertainty of a cycle at temperatures": (
        'uncertainty map.nc plain.csv --temperature "40,60 degC" --points 1', ["map.nc"]),
    "uncertainty of a sweep": ("uncertainty sweep.nc", ["sweep.nc"]),
    "report of changes": ("report pair.nc --set pinion.teeth=9 -o r.html", ["pair.nc"]),
    "plot of a result": ("plot pair.nc planet-loads", ["pair.nc"]),
    "plot of no plot": ("plot map.nc beauty", ["map.nc"]),
    "merge of one shard": ("merge a.nc.shard-1-of-2 -o s.nc", ["a.nc.shard-1-of-2"]),
    "merge of two studies": (
        "merge a.nc.shard-1-of-2 b.nc.shard-1-of-2 -o s.nc",
        ["a.nc.shard-1-of-2", "b.nc.shard-1-of-2"]),
    "merge into another format": (
        "merge a.nc.shard-1-of-2 a.nc.shard-2-of-2 -o s.xyz",
        ["a.nc.shard-1-of-2", "a.nc.shard-2-of-2"]),
    "merge of no shard": ("merge cycle.csv -o s.nc", []),
    "table of pockets of another case": (
        f'run {PAIR} --set models.pocketing_table=pockets.nc --set "operation.speed=9500 rpm" '
        '--set "pinion.face_width=14 mm"', ["pockets.nc"]),
    "table of pockets of a set": (
        "run talbot-2012 --set models.pocketing_table=pockets.nc", ["pockets.nc"]),
    "table of pockets that is a map": (
        f"run {PAIR} --set models.pocketing_table=map.nc", ["map.nc"]),
    "init over a file": ("init cycle.csv", []),
    "rexs over a file": ("rexs import pair.rexs -o cycle.csv", []),
    "rexs of no component": ("rexs import pair.rexs --component 99 -o c.toml", []),
    "rexs of no load case": ("rexs import pair.rexs --load-case 99 -o c.toml", []),
    "rexs of another set": ("rexs export talbot-2012-pair pair.rexs -o r.rexs", []),
    "rexs of a train": ("rexs export train-eaxle pair.rexs -o r.rexs", []),
    "rexs of a train in one stage": (
        "rexs export train-eaxle eaxle.rexs --component 3 -o r.rexs", []),
    "rexs of other sets": ("rexs export train-eaxle two.rexs -o r.rexs", []),
    "rexs of given losses": ("rexs export train-8hp70 -o r.rexs", []),
    "compare of a missing file": (f"compare {PAIR} none.csv", []),
    "compare of another ending": (f"compare {PAIR} cycle.txt", []),
    "points of two columns": (f"sweep {PAIR} --points two.csv -o s.nc", []),
    "points of two units": (f"sweep {PAIR} --points units.csv -o s.nc", []),
    "points of a short row": (f"sweep {PAIR} --points short.csv -o s.nc", []),
    "points of no key": (f"sweep {PAIR} --points colour.csv -o s.nc", []),
    "points of equal rows": (f"sweep {PAIR} --points cycle.csv -o s.nc", []),
    "points of many keys": (f"sweep {PAIR} --points many.csv -o s.nc", []),
    "journal that is a file": (
        f'sweep {PAIR} --vary "operation.speed=1000,2000 rpm" {FEW} -o journal.nc', []),
    "duty shard without a file": (f"duty {PAIR} cycle.csv --shard 1/2", []),
    "duty shard of two files": (f"duty {PAIR} cycle.csv --shard 1/2 -o d.nc --json d.json "
                                "--journal j", []),
    "oil that is no oil": ("oil characterise bad.toml -o d --size 4", []),
    "oil that lacks points": ("oil characterise short.toml -o d --size 4", []),
    "oil model that is none": (f"run {PAIR} --set models.friction=fitted --set "
                               "models.oil_model=model.json", []),
    "oil show of no model": ("oil show model.json", []),
    "oil fit of a folder": ("oil fit .", []),
}  # fmt: skip
"""What is done with files, and which of them are made first."""

DAMAGES: dict[str, tuple[str, list[list[Any]]]] = {
    "other unit of the map": ("map.nc", [["attribute", "speed/units", "mm"]]),
    "other unit of its losses": ("map.nc", [["attribute", "total/units", "kW"],
                                            ["attribute", "torque_loss/units", "kN*m"]]),
    "map without numbers": ("map.nc", [["rename", "total", "gone"]]),
    "map without status": ("map.nc", [["rename", "status", "gone"]]),
    "map without losses": ("map.nc", [["rename", "torque_loss", "gone"]]),
    "map that falls": ("map.nc", [["reverse", "speed"]]),
    "map without end": ("map.nc", [["fill", "speed", None]]),
    "map of infinite losses": ("map.nc", [["fill", "mesh_sliding", float("inf")]]),
    "map of gains": ("map.nc", [["fill", "total", -3.0]]),
    "map of more than all": ("map.nc", [["fill", "efficiency", 1.07]]),
    "map with gaps": ("map.nc", [["first", "torque_loss", None]]),
    "map without labels": ("map.nc", [["no attribute", "total/long_name"]]),
    "map of junk": ("map.nc", [["attribute", "inputs", "{"], ["attribute", "case", "{"]]),
    "map of another case": ("map.nc", [
        ["attribute", "inputs", '{"kind": "other"}'], ["attribute", "case", '{"kind": "other"}']]),
    "result of another format": ("set.nc", [["attribute", "format", "something"]]),
    "result of a later version": ("set.nc", [["attribute", "format_version", 99]]),
    "result without json": ("set.nc", [["attribute", "result", "{"]]),
    "result without date": ("set.nc", [["attribute", "created", "yesterday"]]),
    "gear of endless teeth": ("set.nc", [["attribute", "gears/sun/teeth", 1000000000]]),
    "gear of teeth in words": ("set.nc", [["attribute", "gears/sun/teeth", "many"]]),
    "gear that is half internal": ("set.nc", [["attribute", "gears/sun/internal", 2]]),
    "gear without name": ("set.nc", [["no attribute", "gears/sun/name"]]),
    "gear without size": ("set.nc", [["fill", "gears/ring/tip_diameter", 0.0]]),
    "gear nowhere": ("set.nc", [["fill", "gears/sun/center_x", None]]),
    "mesh without path": ("set.nc", [["rename", "views/sun_mesh/path_x", "gone"]]),
    "mesh without label": ("set.nc", [["no attribute", "meshes/ring_mesh/line_load/units"]]),
    "mesh of endless load": ("set.nc", [["fill", "meshes/sun_mesh/line_load", float("inf")]]),
    "mesh of negative load": ("set.nc", [["fill", "meshes/sun_mesh/line_load", -1e30]]),
    "sweep without losses": ("sweep.nc", [["rename", "total", "gone"]]),
    "sweep of words": ("sweep.nc", [["rename", "efficiency", "gone"]]),
    "sweep without label": ("sweep.nc", [["no attribute", "total/units"]]),
    "pockets of another format": ("pockets.nc", [["attribute", "format", "something"]]),
    "map of words": ("map.nc", [["words", "total"]]),
    "map of words for losses": ("map.nc", [["words", "mesh_sliding"]]),
    "map at words": ("map.nc", [["words", "speed"]]),
    "map of an older case": ("map.nc", [
        ["attribute", "inputs", '{"kind": "gear_pair"}'],
        ["attribute", "case", '{"kind": "gear_pair"}']]),
    "sweep of text": ("sweep.nc", [["words", "total"]]),
    "mesh of words": ("set.nc", [["words", "views/sun_mesh/path_x"]]),
    "band without count": ("set.nc", [["no attribute", "uncertainty/result/failed"]]),
    "band of no title": ("set.nc", [["attribute", "uncertainty/result/title", 3]]),
    "band without units": ("set.nc", [["rename", "uncertainty/result/input_unit", "gone"]]),
    "band without numbers": ("set.nc", [["rename", "uncertainty/result/nominal", "gone"],
                                        ["fill", "uncertainty/result/low", -1e300]]),
    "band without names": ("set.nc", [["rename", "uncertainty/result/result", "gone"]]),
    "drawn band without count": ("band.nc", [["attribute", "failed", "few"]]),
    "drawn band without names": ("band.nc", [["rename", "input_name", "gone"]]),
    "drawn band of other results": ("band.nc", [["first", "result", "sum"]]),
    "drawn band without shares": ("band.nc", [["words", "first_order"]]),
}  # fmt: skip

CALLS: list[Tables] = [
    {"name": "sweep of nothing", "call": "sweep", "case": PAIR, "with": {"vary": {}}},
    {"name": "sweep of no values", "call": "sweep", "case": PAIR,
     "with": {"vary": {"operation.speed": []}}},
    {"name": "sweep together of nothing", "call": "sweep", "case": PAIR,
     "with": {"together": [{}]}},
    {"name": "sweep of a key twice", "call": "sweep", "case": PAIR, "with": {
        "vary": {"pinion.teeth": [24, 25]}, "together": [{"pinion.teeth": [24, 25]}]}},
    {"name": "sweep of points of nothing", "call": "sweep", "case": PAIR, "with": {"points": {}}},
    {"name": "sweep of too many keys", "call": "sweep", "case": PAIR, "with": {
        "points": {f"key{number}": [1] for number in range(900)}}},
    {"name": "sweep of a wrong shard", "call": "sweep", "case": PAIR,
     "with": {"vary": {"pinion.teeth": [24, 25]}, "shard": [3, 2]}},
    {"name": "sweep with a journal that is none", "call": "sweep", "case": PAIR,
     "with": {"vary": {"pinion.teeth": [24, 25]}, "journal": "j", "jobs": 1},
     "files": {"j": "no journal\n"}},
    {"name": "sweep with a journal in a file", "call": "sweep", "case": PAIR,
     "with": {"vary": {"pinion.teeth": [24, 25]}, "journal": "f/j", "jobs": 1},
     "files": {"f": "a file\n"}},
    {"name": "map of nothing", "call": "loss_map", "case": PAIR,
     "with": {"speed": [], "torque": ["1 N*m"]}},
    {"name": "map of a state that cannot run", "call": "loss_map", "case": "train-8hp70",
     "patch": {"states": {"1": {"fixed": [], "joined": []}}, "operation": {"state": "2"}},
     "with": {"speed": ["1 rpm"], "torque": ["1 N*m"], "states": ["1"]}},
    {"name": "measured with wrong confidence", "call": "compare_measured", "case": PAIR,
     "with": {"measured": "m.csv", "confidence": 1.5, "hold_out": 0.2},
     "files": {"m.csv": MEASURED}},
    {"name": "measured neither way", "call": "compare_measured", "case": PAIR,
     "with": {"measured": "m.csv", "load_dependent": "guessed"}, "files": {"m.csv": MEASURED}},
    {"name": "measured where no point can be computed", "call": "compare_measured",
     "case": "talbot-2012", "with": {"measured": "m.csv", "jobs": 1},
     "files": {"m.csv": "speed [rpm],torque [N*m],planet.count,loss [W]\n1000,50,9,3\n"}},
    {"name": "mesh details without load", "call": "mesh_details", "case": PAIR,
     "changes": {"operation.torque": "0 N*m"}},
    {"name": "pocket details left out", "call": "pocket_details", "case": PAIR,
     "changes": {"losses.mesh_pocketing.include": False}},
    {"name": "loaded meshes of given losses", "call": "loaded_meshes", "case": "train-8hp70"},
    {"name": "heat of given losses", "call": "heat_balance", "case": "train-8hp70"},
    {"name": "solve for beauty", "call": "solve_for", "case": PAIR, "with": ["beauty", "90 degC"]},
    {"name": "warm-up of given losses", "call": "warm_up", "case": "train-8hp70",
     "with": {"duration": "2 h"}},
    {"name": "result without ending", "call": "save_result", "case": PAIR,
     "with": {"path": "result.txt"}},
    {"name": "result into no folder", "call": "save_result", "case": PAIR,
     "with": {"path": "no/folder/result.nc"}},
    {"name": "stored result that is text", "call": "open_result", "case": "r.nc",
     "files": {"r.nc": "total = 1"}},
    {"name": "stored result that is empty", "call": "open_result", "case": "r.nc",
     "files": {"r.nc": ""}},
    {"name": "stored result of a signature", "call": "open_result", "case": "r.nc",
     "files": {"r.nc": [137, 72, 68, 70, 13, 10, 26, 10]}},
    {"name": "stored result that is not there", "call": "open_result", "case": "r.nc"},
    {"name": "oil of no file", "call": "characterise_oil", "case": "butter",
     "with": {"folder": "d", "size": 4}},
    {"name": "oil of no size", "call": "characterise_oil", "case": "atf-talbot-2012",
     "with": {"folder": "d", "size": 2000000}},
    {"name": "study of nothing", "call": "pocketing_study", "case": PAIR, "with": {"what": []}},
    {"name": "study without values", "call": "pocketing_study", "case": PAIR,
     "with": {"what": ["speed"], "ranges": {"speed": []}}},
    {"name": "samples of three", "call": "uncertainty", "case": PAIR, "with": {"samples": 3}},
    {"name": "cycle at two temperatures", "call": "uncertainty", "case": PAIR,
     "with": {"cycle": "c.csv", "temperature": ["40 degC", "60 degC"], "points": 1},
     "files": {"c.csv": PLAIN}},
    {"name": "capacity of no part", "call": "warm_up", "case": PAIR, "changes": {
        "thermal.oil_flow": "2 l/min", "thermal.oil_volume": "2 l",
        "thermal.capacities.moon.value": "300 J/K"}, "with": {"duration": "2 h"}},
    {"name": "capacity that is missing", "call": "warm_up", "case": PAIR, "changes": {
        "thermal.housing.area": "0.3 m^2", "thermal.oil_flow": "2 l/min"},
     "with": {"duration": "2 h"}},
    {"name": "table of beauty", "call": "table", "case": PAIR, "with": {"of": "beauty"}},
    {"name": "result into text", "call": "save", "case": PAIR, "with": {"path": "r.txt"}},
    {"name": "plot of beauty", "call": "plot", "case": PAIR, "with": {"what": "beauty"}},
]  # fmt: skip

REXS: dict[str, list[tuple[str, str]]] = {
    "no model": [("<model", "<modell"), ("</model", "</modell")],
    "open tag": [("</components>", "")],
    "no version": [(' version="2.0.0"', "")],
    "another version": [('version="2.0.0"', 'version="9.0.0"')],
    "no components": [("<components>", "<parts>"), ("</components>", "</parts>")],
    "entity": [("<model", '<!DOCTYPE m [<!ENTITY a "b">]><model')],
    "no teeth": [('"number_of_teeth"', '"number_of_tooth"')],
    "words for numbers": [(">25<", ">many<"), (">24<", ">many<"), (">19<", ">many<")],
    "another unit": [('unit="mm"', 'unit="furlong"')],
    "no relations": [("<relations>", "<relation_s>"), ("</relations>", "</relation_s>")],
    "no stage": [('"cylindrical_stage"', '"bevel_stage"')],
    "no gears": [('"cylindrical_gear"', '"bevel_gear"')],
}  # fmt: skip

HELP = (
    "run", "check", "sweep", "map", "merge", "duty", "uncertainty", "compare-cases", "heat",
    "warm-up", "mesh", "pockets", "pockets-table", "study", "contact", "oil", "oil characterise",
    "oil fit", "oil show", "friction", "compare", "validate", "reproduce", "cases", "oils", "init",
    "app", "report", "plot", "rexs", "rexs import", "rexs export", "schema",
)  # fmt: skip
SOUND: dict[str, str] = {
    "run of a set": "run talbot-2012 --set numerics.pocket_slices=6 --set numerics.pocket_steps=10",
    "run of a pair": f"run {PAIR}",
    "run of a gearbox": "run train-8hp70",
    "run of an axle": "run train-eaxle --set numerics.mesh_positions=5 --set "
                      "numerics.contact_segments=5",
    "run with temperatures": f'run {PAIR} --set models.temperatures=network --set '
                             '"thermal.oil_flow=2 l/min" --set lubrication.method=jet',
    "check of a set": "check talbot-2012",
    "check of a pair": f"check {PAIR} --set lubrication.method=spray",
    "check of a gearbox": "check train-8hp70",
    "check of an axle": "check train-eaxle",
    "friction of a set": "friction talbot-2012 --set numerics.pocket_slices=6 --set "
                         "numerics.pocket_steps=10",
    "friction of a pair": f"friction {PAIR}",
    "mesh of a pair": f'mesh {PAIR} --set "operation.torque=90 N*m"',
    "pockets of a pair": f"pockets {PAIR}",
    "heat of a pair": f'heat {PAIR} --set "thermal.oil_flow=2 l/min"',
    "heat that is solved for": f'heat {PAIR} --solve oil_flow --target "97 degC" --set '
                               '"operation.torque=90 N*m"',
    "sweep of a pair": f'sweep {PAIR} --vary "operation.speed=1000,2000 rpm" {FEW} -o s.csv',
    "uncertainty of a pair": f"uncertainty {PAIR} --samples 8 {FEW}",
    "cases": "cases",
    "oils": "oils",
    "oil": "oils atf-talbot-2012",
    "another oil": "oils iso-vg-100-mineral",
    "minimal case": "init case.toml --minimal",
    "plots of a pair": f"plot {PAIR}",
    "comparison": f"compare {PAIR} measured.csv {FEW}",
    "validation": "validate",
    "import of a pair": "rexs import pair.rexs -o c.toml",
    "import of an axle": "rexs import eaxle.rexs -o c.toml",
    "import of a set": "rexs import set.rexs -o c.toml",
}  # fmt: skip
"""Commands that succeed; of some the files that they write are shown afterwards."""
SOUND_MAPS: dict[str, tuple[str, list[str]]] = {
    "duty of a map": ("duty map.nc cycle.csv", ["map.nc"]),
    "duty beyond a map": ("duty cool.nc plain.csv --clamp", ["cool.nc"]),
    "merged sweep": (
        "merge a.nc.shard-1-of-2 a.nc.shard-2-of-2 -o a.csv",
        ["a.nc.shard-1-of-2", "a.nc.shard-2-of-2"]),
    "stored map as csv": ("map map.nc -o n.csv", ["map.nc"]),
    "plots of a map": ("plot map.nc", ["map.nc"]),
    "plots of a result": ("plot set.nc", ["set.nc"]),
    "table of pockets": (
        f"run {PAIR} --set models.pocketing_table=pockets.nc", ["pockets.nc"]),
}  # fmt: skip


def _files() -> dict[str, str]:
    return {
        "cycle.csv": CYCLE,
        "plain.csv": PLAIN,
        "states.csv": "share,speed [rpm],torque [N*m],state\n1,500,20,1\n1,500,20,12\n",
        "ones.csv": "share,speed [rpm],torque [N*m],state\n1,500,20,1\n1,500,20,2\n",
        "cycle.txt": CYCLE,
        "cycle.parquet": "no parquet",
        "measured.csv": MEASURED,
        "two.csv": "pinion.teeth,pinion.teeth\n24,25\n",
        "units.csv": "pinion.face_width [mm],pinion.face_width [m]\n24,25\n",
        "short.csv": "pinion.teeth,gear.teeth\n24,25\n25,\n",
        "colour.csv": "pinion.colour\nred\n",
        "many.csv": ",".join(f"key{n}" for n in range(400)) + "\n" + ",".join("1" * 400) + "\n",
        "bad.toml": 'kind = "mineral"\ncolour = "red"\n',
        "short.toml": 'kind = "mineral"\n[[kinematic_viscosity]]\ntemperature = "40 degC"\n'
                      'value = "30 mm"\n',
        "model.json": '{"version": 2}\n',
        "pair.rexs": rexs_files.pair().xml(),
        "set.rexs": rexs_files.planetary().xml(),
        "eaxle.rexs": rexs_files.eaxle().xml(),
        "two.rexs": rexs_files.two_planetary().xml(),
        **PROFILES,
    }  # fmt: skip


def _command(name: str, text: str, files: dict[str, str], made: list[str] | None = None) -> Tables:
    arguments = shlex.split(text)
    used = {file: content for file, content in files.items() if any(file in it for it in arguments)}
    entry: Tables = {"name": name, "call": "command", "with": arguments}
    return entry | ({"files": used} if used else {}) | ({"made": made} if made else {})


def broken_commands() -> Iterator[Tables]:
    """What is refused, as entries."""
    files = _files()
    for name, text in COMMANDS.items():
        yield _command(name, text, {})
    for name, text in CONTACTS.items():
        yield _command(f"contact: {name}", f"{CONTACT} {text}", files)
    for name, (text, made) in OF_MAPS.items():
        cut = {"damage": {made[0]: ["last line"]}} if "cut" in name else {}
        yield _command(name, text, files, made) | cut
    for name, cycle in CYCLES.items():
        yield _command(f"cycle: {name}", "duty map.nc c.csv", {"c.csv": cycle}, ["map.nc"])
    for name, table in MEASUREMENTS.items():
        yield _command(f"measured: {name}", f"compare {PAIR} m.csv {FEW}", {"m.csv": table})
    for name, text in COMPARISONS.items():
        command = f"compare {PAIR} m.csv {FEW} {text}"
        yield _command(f"comparison: {name}", command, {"m.csv": MEASURED})
    for name, (file, edits) in DAMAGES.items():
        entry = {"name": f"damaged: {name}", "call": "open_result", "case": file, "made": [file]}
        yield entry | {"damage": {file: edits}}
        if file == "map.nc":
            entry = _command(f"duty of damaged: {name}", "duty map.nc cycle.csv", files, [file])
            yield entry | {"damage": {file: edits}}
            entry = _command(f"written of damaged: {name}", "map map.nc -o n.csv", {}, [file])
            yield entry | {"damage": {file: edits}}
            text = "map map.nc --temperature-state -o n.nc"
            entry = _command(f"state of damaged: {name}", text, {}, [file])
            yield entry | {"damage": {file: edits}}
            if "gaps" not in name:  # of which the band would be computed
                entry = _command(f"band of damaged: {name}", "uncertainty map.nc", {}, [file])
                yield entry | {"damage": {file: edits}}
    for name, edits in REXS.items():
        for file in ("pair.rexs", "set.rexs"):
            text = files[file]
            for old, new in edits:
                text = text.replace(old, new)
            entry = {"name": f"{file}: {name}", "call": "read_rexs", "case": file}
            yield entry | {"files": {file: text}}
    for entry in CALLS:
        yield entry | {"name": f"call: {entry['name']}"}


def sound_commands() -> Iterator[Tables]:
    """What commands say that succeed, and their help."""
    files = _files()
    yield _command("help", "--help", {})
    for name in HELP:
        yield _command(f"help of {name}", f"{name} --help", {})
    for name, text in SOUND.items():
        yield _command(name, text, files)
    for name, (text, made) in SOUND_MAPS.items():
        yield _command(name, text, files, made)
