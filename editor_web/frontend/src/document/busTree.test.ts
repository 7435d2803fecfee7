/** The tree of a bus. */
import { expect, test } from 'vitest'
import { byNamespace, found } from './busTree'
import { nameOfPath } from './path'

const entry = (name: string, type = 'Number', doc = '') => ({ name, type, doc })

test('entries are grouped by namespace and sorted', () => {
  const groups = byNamespace([entry('left/b'), entry('cell'), entry('left/gripper/x'), entry('left/a')])
  expect(groups.map((group) => [group.name, group.entries.map((each) => nameOfPath(each.name))])).toEqual([
    ['', ['cell']],
    ['left', ['a', 'b']],
    ['left/gripper', ['x']],
  ])
})

test('a search wants all its words, in name, type or text', () => {
  const entries = [entry('left/move', 'MoveJoints', 'Go there.'), entry('right/move', 'MoveJoints'), entry('left/stop', 'Halt')]
  expect(found(entries, ' LEFT move').map((each) => each.name)).toEqual(['left/move'])
  expect(found(entries, 'go there')).toHaveLength(1)
  expect(found(entries, '')).toBe(entries)
})
