/** What a parameter may be declared to name. */
import { expect, it } from 'vitest'
import { fittingNames, nameKindOf, nameKinds, namingOf } from './parameterNames'

const FROM = {
  names: { robot: ['left', 'right'], camera: ['eye'] },
  entries: [
    { kind: 'joints', name: 'home' },
    { kind: 'pose', name: 'tray' },
  ],
}

it('lists what the cell and its store have, and a kind of its own that they lack', () => {
  expect(nameKinds(FROM, {}).map((kind) => kind.label)).toEqual(['camera', 'robot', 'entry: joints', 'entry: pose'])
  expect(nameKinds(FROM, { cell_name: 'scene_part' })[0]).toEqual({ value: 'cell_name scene_part', label: 'scene part' })
})

it('is written as one word and read from it', () => {
  expect(namingOf('cell_name robot')).toEqual({ cell_name: 'robot', entry: undefined })
  expect(namingOf('entry joints')).toEqual({ cell_name: undefined, entry: 'joints' })
  expect(namingOf('')).toEqual({ cell_name: undefined, entry: undefined })
  expect(nameKindOf({ type: 'string', entry: 'pose' })).toBe('entry pose')
})

it('offers the names that fit', () => {
  expect(fittingNames(FROM, { cell_name: 'robot' })).toEqual(['left', 'right'])
  expect(fittingNames(FROM, { entry: 'joints' })).toEqual(['home'])
  expect(fittingNames(FROM, { cell_name: 'person' })).toEqual([])
  expect(fittingNames(FROM, {})).toEqual([])
})
