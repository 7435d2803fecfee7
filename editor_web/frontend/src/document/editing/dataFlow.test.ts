import { expect, test } from 'vitest'
import type { KeyFlow, KeyReader } from '../../api/types'
import { drawnLinks, flowCurve, flowOfNode, linksOf, soundnessOf } from './dataFlow'

const reader = (path: string, sources: readonly string[], defined: KeyReader['defined'] = 'always'): KeyReader => ({
  path,
  by: 'mapped',
  name: 'value',
  required: true,
  defined,
  sources,
  witness: '',
})
const COUNT: KeyFlow = {
  key: 'count',
  writers: [
    { path: '', origin: 'userdata', name: 'count' },
    { path: 'root/box/set', origin: 'output', name: 'value' },
  ],
  readers: [reader('root/show', ['', 'root/box/set']), reader('root/box/add', ['root/box/set'], 'maybe')],
}
const OTHER: KeyFlow = { key: 'other', writers: [], readers: [reader('root/show', ['root/box/set'])] }

test('each reader has an arrow from each that its value may come from', () => {
  expect(linksOf([COUNT, OTHER], 'count').map((link) => `${link.from}>${link.to}`)).toEqual([
    '>root/show',
    'root/box/set>root/show',
    'root/box/set>root/box/add',
  ])
  expect(linksOf([COUNT, OTHER], undefined)).toHaveLength(4)
})

test('what is inside of a closed container is drawn at it, once', () => {
  const links = drawnLinks(linksOf([COUNT, OTHER], undefined), new Set(['root/box', 'root/show']))
  expect(links).toEqual([
    { from: '', to: 'root/show', key: 'count', isUnsure: false },
    { from: 'root/box', to: 'root/show', key: 'count, other', isUnsure: false },
  ])
})

test('a key is as sound as the worst of its readers', () => {
  expect(soundnessOf(COUNT)).toBe('maybe')
  expect(soundnessOf({ ...COUNT, readers: [reader('root/a', [], 'never'), reader('root/b', [''])] })).toBe('never')
  expect(soundnessOf({ ...COUNT, readers: [] })).toBe('sound')
})

test('a node is told what it reads and who reads what it writes', () => {
  const flow = flowOfNode([COUNT, OTHER], 'root/box/set')
  expect(flow.reads).toEqual([])
  expect(flow.writes.map((each) => [each.key, each.readers])).toEqual([['count', ['root/show', 'root/box/add']]])
})

test('a curve begins and ends at the edges, or at the head of what is around the other', () => {
  const left = { x: 0, y: 0, width: 100, height: 50 }
  const right = { x: 300, y: 0, width: 100, height: 50 }
  expect(flowCurve(left, right).path).toMatch(/^M 100 25 Q .* 300 25$/)
  expect(flowCurve({ x: -50, y: -50, width: 900, height: 500 }, right).path).toMatch(/^M -24 -30 /)
})
