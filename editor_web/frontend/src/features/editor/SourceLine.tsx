/** Where the class of a state is: its file and line, which opens it, and a button that copies them. */
import { CopyButton, Group } from '@mantine/core'
import { IconCheck, IconCode, IconCopy } from '@tabler/icons-react'
import { useAnswer } from '../../api/queryClient'
import { stateSourceQuery } from '../../api/stateSource'
import type { StateSource } from '../../api/types'
import { LinkButton } from './FormParts'
import { showSource } from './stateSource'
import { Tool } from './Tool'

export function SourceLine({ state }: { readonly state: string }) {
  const { value: source } = useAnswer(stateSourceQuery(state))
  if (!source) return null
  return (
    <Group gap="3xs" wrap="nowrap" fz="xs" style={{ overflowWrap: 'anywhere' }}>
      <LinkButton isMono title={`Source of ${state}: ${fileAndLine(source)}`} onPress={() => showSource(state)}>
        <IconCode size={13} aria-hidden /> {shortPlace(source)}
      </LinkButton>
      <CopyPlace source={source} />
    </Group>
  )
}

/** Copies `file:line`, as editors and debuggers take it. */
export function CopyPlace({ source }: { readonly source: StateSource }) {
  return (
    <CopyButton value={fileAndLine(source)}>
      {({ copied, copy }) => (
        <Tool isSmall label={copied ? 'Copied' : 'Copy file and line'} title={fileAndLine(source)} onPress={copy}>
          {copied ? <IconCheck size={14} aria-hidden /> : <IconCopy size={14} aria-hidden />}
        </Tool>
      )}
    </CopyButton>
  )
}

export function fileAndLine({ file, line }: StateSource): string {
  return `${file}:${line}`
}

/** The last folders are enough beside a form. */
function shortPlace({ file, line }: StateSource): string {
  return `${file.split(/[/\\]/).slice(-3).join('/')}:${line}`
}
