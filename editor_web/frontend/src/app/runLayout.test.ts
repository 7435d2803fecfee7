/** Which layout an address carries. */
import { expect, it } from 'vitest'
import { layoutOf, withLayout } from './runLayout'

it.each([
  ['', undefined],
  ['?layout=debug', 'debug'],
  ['?a=1&layout=3d', '3d'],
  ['?layout=sideways', undefined],
])('reads %j as %s', (search, layout) => {
  expect(layoutOf(search)).toBe(layout)
})

it('puts the layout into the address, and leaves the rest of it', () => {
  expect(withLayout('http://h/runs/r1?a=1&layout=debug#x', '3d')).toBe('http://h/runs/r1?a=1&layout=3d#x')
})
