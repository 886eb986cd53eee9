// A scene of twenty spots, each a light of its own, at 1280×720: node twenty_lights.mjs > twenty.pbrt
const colors = [[1, 0.5, 0.3], [0.4, 0.6, 1], [0.5, 1, 0.5], [1, 0.9, 0.6]];

export function twentyLights() {
  const lines = ['LookAt 0 -9 4  0 0 1  0 0 1', 'Camera "perspective" "float fov" 40',
    'Film "rgb" "integer xresolution" 1280 "integer yresolution" 720', 'Sampler "zsobol" "integer pixelsamples" 64',
    'Integrator "path" "integer maxdepth" 4', 'WorldBegin', 'Material "diffuse" "rgb reflectance" [ 0.6 0.6 0.6 ]',
    'Shape "bilinearmesh" "point3 P" [ -8 -8 0  8 -8 0  -8 8 0  8 8 0 ]',
    'Shape "bilinearmesh" "point3 P" [ -8 4 0  8 4 0  -8 4 8  8 4 8 ]'];
  for (let i = 0; i < 20; i++) {
    const x = (-5 + (10 * (i % 10)) / 9).toFixed(3), y = i < 10 ? -1 : 2.5;
    const color = colors[i % 4].map((channel) => 12 * channel).join(' ');
    lines.push(`LightSource "spot" "string name" "lamp ${i + 1}" "rgb I" [ ${color} ] "point3 from" [ ${x} ${y} 4 ] ` +
      `"point3 to" [ ${(0.9 * x).toFixed(3)} ${y + 0.4} 0 ] "float coneangle" 25`);
  }
  for (let i = 0; i < 6; i++)
    lines.push(`AttributeBegin Translate ${(-4 + 1.6 * i).toFixed(1)} ${0.5 + (i % 2)} 0.6 Shape "sphere" "float radius" 0.6 AttributeEnd`);
  return lines.join('\n') + '\n';
}

process.stdout.write(twentyLights());
