/** Where the behaviors of the project use a state, a behavior, an entry or a key; each place leads to its node. */
import { Autocomplete, Code, Group, List, ScrollArea, SegmentedControl, Stack, Text, Title } from '@mantine/core'
import { useQuery } from '@tanstack/react-query'
import { useState } from 'react'
import { Refusal } from '../../components/Refusal'
import { catalogueQuery } from '../../api/catalogueQuery'
import { useAnswer } from '../../api/queryClient'
import type { CatalogueBody, Usage } from '../../api/types'
import { findUsages, usagesQuery } from '../../api/usages'
import { Dialog } from '../../components/Dialog'
import { TextButton } from '../../components/TextButton'
import type { Used, UsedKind } from '../../document/editing/usedBy'
import { nameOfPath } from '../../document/path'

export interface UsagesDialogProps {
  readonly asked: Used
  /** Go to a node of a document; to the document itself where the path is empty. */
  readonly onOpen: (document: string, path: string) => void
}

const KINDS: readonly { readonly value: UsedKind; readonly label: string }[] = [
  { value: 'state', label: 'State' },
  { value: 'behavior', label: 'Behavior' },
  { value: 'entry', label: 'Entry' },
  { value: 'key', label: 'Userdata key' },
]

export function UsagesDialog({ asked, onOpen }: UsagesDialogProps) {
  const [used, setUsed] = useState(asked)
  const { data: catalogue } = useQuery(catalogueQuery())
  const { value, problem } = useAnswer(usagesQuery(used))
  const found = value?.found ?? []
  const byDocument = new Map(found.map(({ document }) => [document, found.filter((usage) => usage.document === document)]))
  const close = () => findUsages(undefined)
  return (
    <Dialog isOpen onClose={close} title="Usages">
      <Stack gap="xs" w="min(46rem, 86vw)">
        <Group gap="xs">
          <SegmentedControl
            size="xs"
            aria-label="What is looked for"
            data={[...KINDS]}
            value={used.kind}
            onChange={(kind) => setUsed({ kind, name: '' })}
          />
          <Autocomplete
            size="xs"
            flex={1}
            data-autofocus
            aria-label="Its name"
            placeholder="Its name"
            value={used.name}
            data={namesOf(used.kind, catalogue)}
            limit={30}
            onChange={(name) => setUsed({ ...used, name })}
          />
        </Group>
        <Refusal>{problem}</Refusal>
        <Text size="sm" c="dimmed" role="status">
          {used.name === '' ? 'Of which one?' : value && wordsOf(value.found, byDocument.size)}
        </Text>
        <ScrollArea.Autosize mah="52vh">
          {[...byDocument].map(([document, usages]) => (
            <section key={document} aria-label={document}>
              <Title order={3} fz="sm" fw={620} mt="xs">
                {usages[0]?.behavior}{' '}
                <Text span size="xs" c="dimmed" ff="monospace">
                  {document}
                </Text>
              </Title>
              <List listStyleType="none" fz="sm">
                {usages.map((usage) => (
                  <Place
                    key={`${usage.line}:${usage.column} ${usage.path} ${usage.how}`}
                    usage={usage}
                    onOpen={() => {
                      close()
                      onOpen(document, usage.path)
                    }}
                  />
                ))}
              </List>
            </section>
          ))}
          {value && value.unread.length > 0 && (
            <Text size="xs" c="var(--stopped)" mt="xs">
              These cannot be read, and may use it too: {value.unread.join(', ')}
            </Text>
          )}
        </ScrollArea.Autosize>
        <Text size="xs" c="dimmed">
          Documents are looked at as they are saved; disabled nodes count.
        </Text>
      </Stack>
    </Dialog>
  )
}

function Place({ usage, onOpen }: { usage: Usage; onOpen: () => void }) {
  const place = usage.path || 'the behavior itself'
  return (
    <Group component="li" gap="xs" wrap="nowrap" py={2}>
      <Text span inherit flex={1} miw={0} truncate>
        <TextButton label={`${place}, ${usage.how}, line ${usage.line}`} onPress={onOpen}>
          {place}
        </TextButton>
      </Text>
      <Text span size="xs" c="dimmed">
        {usage.how}
      </Text>
      <Code fz="xs">
        {nameOfPath(usage.document)}:{usage.line}
      </Code>
    </Group>
  )
}

function namesOf(kind: UsedKind, catalogue: CatalogueBody | undefined): string[] {
  if (!catalogue) return []
  if (kind === 'state') return catalogue.states.map((state) => state.name)
  if (kind === 'behavior') return catalogue.behaviors.map((behavior) => behavior.id)
  return kind === 'entry' ? [...new Set(catalogue.entries.map((entry) => entry.name))] : []
}

function wordsOf(found: readonly Usage[], documentCount: number): string {
  if (found.length === 0) return 'Nothing uses it.'
  const places = found.length === 1 ? 'One place' : `${found.length} places`
  return `${places} in ${documentCount === 1 ? 'one document' : `${documentCount} documents`}`
}
