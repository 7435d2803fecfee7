import { expect, test } from 'vitest'
import { entryLines } from './entryText'

test('joints are named, in radians and degrees', () => {
  expect(entryLines('joints', { joints: [-Math.PI / 2, 0], names: ['shoulder'] })).toEqual([
    { label: 'shoulder', words: '-1.571 (-90.0°)' },
    { label: 'joint 2', words: '0.000 (0.0°)' },
  ])
})

test('a pose is a place and a turn in degrees', () => {
  const half = Math.sqrt(0.5)
  expect(entryLines('pose', { xyz: [0.2, 0.7, 0.3], xyzw: [0, 0, half, half], frame: 'world' })).toEqual([
    { label: 'place', words: '0.200, 0.700, 0.300 m' },
    { label: 'roll, pitch, yaw', words: '0.0, 0.0, 90.0°' },
    { label: 'frame', words: 'world' },
  ])
})

test('anything else is shown field by field, and never at length', () => {
  const lines = entryLines('dmp', { weights: Array.from({ length: 500 }, () => 0.5), name: 'wipe' })
  expect(lines.map((line) => line.label)).toEqual(['weights', 'name'])
  expect(lines[0]?.words.length).toBeLessThan(70)
  expect(entryLines('joints', { joints: 'nonsense' })).toEqual([])
})
