/** Two versions side by side: what differs in words, on both drawings, and in the text; one alone read-only. */
import { Box, Code, Flex, Group, SimpleGrid, Stack, Tabs, Text } from '@mantine/core'
import { useEffect, useMemo, useState, type ReactNode } from 'react'
import type { DocumentDiff } from '../../api/types'
import { layOutByElk } from '../../components/elk'
import { containersOfMarks, markingsOf, meaningful, wordsOfChange, type Marking } from '../../document/editing/changes'
import type { EditNode } from '../../document/editing/model'
import { drawingOf, openWith, type Drawing } from './drawing'
import { FormWords } from './FormParts'
import { LineDiff } from './LineDiff'
import { Picture } from './Picture'
import { OF_PAGE } from './pictureParts'
import { PlainList } from './PlainList'
import classes from './versions.module.css'

/** One version, or the draft. */
export interface Shown {
  readonly text: string
  /** Undefined where the text cannot be read. */
  readonly root: EditNode | undefined
  readonly outcomes: readonly string[]
  readonly words: string
}

export interface VersionViewProps {
  readonly before: Shown | undefined
  readonly after: Shown
  readonly difference: DocumentDiff | undefined
}

const VIEWS = ['Changes', 'This version', 'Text'] as const
type View = (typeof VIEWS)[number]

export function VersionView({ before, after, difference }: VersionViewProps) {
  const [view, setView] = useState<View>(before ? 'Changes' : 'This version')
  return (
    <Tabs value={view} onChange={(value) => setView((value ?? 'Text') as View)} keepMounted={false}>
      <Tabs.List aria-label="What is shown">
        {VIEWS.map((each) => (
          <Tabs.Tab key={each} value={each}>
            {each}
          </Tabs.Tab>
        ))}
      </Tabs.List>
      <Tabs.Panel value="Changes" pt="2xs">
        {before ? (
          <Changes before={before} after={after} difference={difference} />
        ) : (
          <FormWords>This is the oldest version that is kept.</FormWords>
        )}
      </Tabs.Panel>
      <Tabs.Panel value="This version" pt="2xs">
        <Drawn of={after} markings={NO_MARKS} rowPx={ROW_PX} />
      </Tabs.Panel>
      <Tabs.Panel value="Text" pt="2xs">
        <TextDifference before={before} after={after} />
      </Tabs.Panel>
    </Tabs>
  )
}

const ROW_PX = 1100
const HALF_ROW_PX = 640
const EDGES: Readonly<Record<string, string>> = { added: 'var(--done)', removed: 'var(--failed)' }
const NO_MARKS: ReadonlyMap<string, Marking> = new Map()

function Changes({ before, after, difference }: { before: Shown; after: Shown; difference: DocumentDiff | undefined }) {
  const changes = useMemo(() => meaningful(difference?.changes ?? []), [difference])
  const marks = useMemo(() => markingsOf(changes, before.root, after.root), [changes, before, after])
  const words = changes.map(wordsOfChange)
  if (!difference) return <FormWords>One of the two cannot be read as a behavior; the tab Text shows how they differ.</FormWords>
  if (changes.length === 0)
    return (
      <FormWords>{before.text === after.text ? 'The two are the same.' : 'They mean the same; only comments or layout differ.'}</FormWords>
    )
  return (
    <Stack gap="xs">
      <Box mah="11rem" style={{ overflowY: 'auto' }}>
        <PlainList label="What differs">
          {difference.layout_only && <li>Only places on the canvas differ.</li>}
          {words.map((each, index) => (
            <Flex
              key={index}
              component="li"
              wrap="wrap"
              columnGap="sm"
              px={10}
              py={3}
              fz="sm"
              style={{ borderLeft: `3px solid ${EDGES[each.kind] ?? 'var(--stopped)'}` }}
            >
              <strong>{each.title}</strong>
              {each.lines.map((line, at) => (
                <Text key={at} span inherit c="dimmed">
                  {line}
                </Text>
              ))}
            </Flex>
          ))}
        </PlainList>
      </Box>
      <SimpleGrid cols={{ base: 1, md: 2 }} spacing="xs">
        <Figure caption={before.words}>
          <Drawn of={before} markings={marks.before} rowPx={HALF_ROW_PX} />
        </Figure>
        <Figure caption={after.words}>
          <Drawn of={after} markings={marks.after} rowPx={HALF_ROW_PX} />
        </Figure>
      </SimpleGrid>
      <Group gap="xs" fz="xs">
        <Text inherit c="var(--done)">
          + added
        </Text>
        <Text inherit c="var(--failed)">
          − removed
        </Text>
        <Text inherit c="var(--stopped)">
          ≠ changed or moved
        </Text>
      </Group>
    </Stack>
  )
}

function Figure({ caption, children }: { caption: string; children: ReactNode }) {
  return (
    <Box component="figure" m={0} miw={0}>
      <Text component="figcaption" size="sm" fw={620} mb={3}>
        {caption}
      </Text>
      {children}
    </Box>
  )
}

function Drawn({ of, markings, rowPx }: { of: Shown; markings: ReadonlyMap<string, Marking>; rowPx: number }) {
  const [drawing, setDrawing] = useState<Drawing>()
  const [problem, setProblem] = useState('')
  const { root, outcomes, words } = of
  useEffect(() => {
    if (!root) return
    let isCurrent = true
    // Beside one another there is little room: what is marked is shown, the rest stays closed.
    const needed = containersOfMarks(markings)
    const isOpen = rowPx < ROW_PX ? (path: string) => needed.has(path) : openWith(root)
    drawingOf(root, outcomes, isOpen, rowPx, layOutByElk).then(
      (made) => isCurrent && setDrawing(made),
      (error: unknown) => isCurrent && setProblem(String(error)),
    )
    return () => {
      isCurrent = false
    }
  }, [root, outcomes, markings, rowPx])
  if (!root || problem) return <FormWords>{problem || 'This text cannot be read as a behavior.'}</FormWords>
  return (
    <div
      className={classes['framed']}
      style={{ maxHeight: '30rem' }}
      role="region"
      tabIndex={0}
      aria-label={`Drawing of the version ${words}`}
    >
      {drawing && <Picture drawn={drawing} title={words} palette={OF_PAGE} markings={markings} />}
    </div>
  )
}

function TextDifference({ before, after }: { before: Shown | undefined; after: Shown }) {
  if (!before) return <Code block>{after.text}</Code>
  return (
    <>
      <SimpleGrid cols={2} fz="sm" mb={4}>
        <strong>{before.words}</strong>
        <strong>{after.words}</strong>
      </SimpleGrid>
      <LineDiff label="Differences, the older one on the left" left={before.text} right={after.text} />
    </>
  )
}
