import { expect, it } from 'vitest'
import {
  addressOf,
  depthOf,
  fileTitle,
  firstOfPath,
  nameOfPath,
  parentPath,
  pathOfAddress,
  pathsTo,
  pathWords,
  relativePath,
  restOfPath,
} from './path'

it('takes a path apart', () => {
  const path = 'root/inner/grasp'
  expect([firstOfPath(path), nameOfPath(path), parentPath(path), depthOf(path)]).toEqual(['root', 'grasp', 'root/inner', 2])
  expect(pathsTo(path)).toEqual(['root', 'root/inner', path])
  expect(restOfPath(path)).toBe('inner/grasp')
  expect(restOfPath('root')).toBe('')
  expect(pathWords(path)).toBe('inner › grasp')
})

it('has nothing above a path of one part', () => {
  expect([firstOfPath('root'), nameOfPath('root'), parentPath('root'), depthOf('root')]).toEqual(['root', 'root', '', 0])
  expect([pathsTo('root'), pathWords('root')]).toEqual([['root'], 'root'])
})

it('names a document by its file', () => {
  expect(fileTitle('behaviors/a.b/pick_2.yaml')).toBe('pick_2')
  expect(fileTitle('pick')).toBe('pick')
})

it('writes the way to another document as a reference', () => {
  expect(relativePath('behaviors/a/one.yaml', 'behaviors/a/two.yaml')).toBe('two.yaml')
  expect(relativePath('behaviors/a/one.yaml', 'behaviors/b/c/two.yaml')).toBe('../b/c/two.yaml')
})

it('comes back out of an address as it was put in', () => {
  const path = 'behaviors/50% faster/näher?.yaml'
  expect(pathOfAddress(addressOf(path).split('/'))).toBe(path)
  expect(pathOfAddress(['50%'])).toBe('50%')
})
